// Conforming, first half: every segment is a chain of mesh edges from end to end. The chain comes from the labelled
// edges, or, where edges carry no labels, from the vertices that the segment is the source of, or from a walk along it.
// A chain is right when it starts and ends at the segment's ends, consists of edges of tetrahedra, moves forward along
// the segment with every step (exactly) and has every vertex within `deviation` of it. Then it is a graph over the
// segment, so that it stands for the segment in the windings that check_facets counts.
#include <algorithm>

#include "verify/distance.h"
#include "verify/parallel.h"
#include "verify/subject.h"

namespace certa::verify {
namespace {

class ChainFinder {
public:
    ChainFinder(const Subject& subject, Findings& findings) : subject_(subject), findings_(findings) {}

    std::vector<std::vector<std::uint32_t>> run() {
        chains_.resize(subject_.plc.segments.size());
        if (subject_.edge_labels && !subject_.mesh.edges.empty()) {
            sort_edges();
            for (std::uint32_t s = 0; s < chains_.size(); ++s) link_edges(s);
        } else {
            if (subject_.sources) collect_sources();
            for (std::uint32_t s = 0; s < chains_.size(); ++s) {
                if (!subject_.plc.dropped[s]) look_up(s);
            }
        }
        return std::move(chains_);
    }

private:
    /// Edges by segment; labels out of range and edges that are none are reported here.
    void sort_edges() {
        const TetMesh& mesh = subject_.mesh;
        offsets_.assign(chains_.size() + 1, 0);
        for (std::uint32_t i = 0; i < mesh.edges.size(); ++i) {
            const std::uint32_t s = index_of(mesh.edge_segments[i]);
            if (s < chains_.size()) {
                ++offsets_[s + 1];
                continue;
            }
            findings_.add(Promise::labelled, {edge_ref(i)}, subject_.at(mesh.edges[i][0]),
                          show("edge", i) + " is labelled with " + show("segment", s) + ", but there are " +
                              std::to_string(chains_.size()));
        }
        for (std::size_t s = 0; s < chains_.size(); ++s) offsets_[s + 1] += offsets_[s];
        sorted_.resize(offsets_.back());
        std::vector<std::uint64_t> next(offsets_.begin(), offsets_.end() - 1);
        for (std::uint32_t i = 0; i < mesh.edges.size(); ++i) {
            const std::uint32_t s = index_of(mesh.edge_segments[i]);
            if (s < chains_.size()) sorted_[next[s]++] = i;
        }
    }

    /// Puts a segment's edges end to end; they may come in any order.
    void link_edges(std::uint32_t s) {
        const TetMesh& mesh = subject_.mesh;
        const auto begin = sorted_.begin() + static_cast<std::ptrdiff_t>(offsets_[s]);
        const auto end = sorted_.begin() + static_cast<std::ptrdiff_t>(offsets_[s + 1]);
        if (begin == end) {
            if (!subject_.plc.dropped[s]) fail(s, no_index, "no edge is labelled with it");
            return;
        }
        // Every edge twice, from either end: a chain is followed whatever the directions of its edges.
        std::vector<std::array<std::uint32_t, 2>> steps;
        for (auto i = begin; i != end; ++i) {
            for (const VertexId v : mesh.edges[*i]) steps.push_back({index_of(v), *i});
        }
        std::sort(steps.begin(), steps.end());
        const auto& ends = subject_.plc.segments[s];
        const auto count = static_cast<std::size_t>(end - begin);
        std::vector<std::uint32_t> chain{ends[0]};
        std::uint32_t last = no_index;
        while (chain.size() <= count) {
            std::uint32_t next = no_index;
            for (auto i = std::lower_bound(steps.begin(), steps.end(), std::array<std::uint32_t, 2>{chain.back(), 0});
                 i != steps.end() && (*i)[0] == chain.back(); ++i) {
                if ((*i)[1] == last) continue;
                if (next != no_index) {
                    fail(s, (*i)[1], "it branches at " + show("vertex", chain.back()));
                    return;
                }
                next = (*i)[1];
            }
            if (next == no_index) break;
            follow(s, next, chain);
            last = next;
        }
        if (chain.size() == count + 1 && chain.back() == ends[1]) {
            chains_[s] = std::move(chain);
            return;
        }
        fail(s, *begin,
             "its " + std::to_string(count) + " labelled edges do not lead from end to end: the chain from " +
                 show("vertex", ends[0]) + " stops after " + std::to_string(chain.size() - 1) + " edges at " +
                 show("vertex", chain.back()));
    }

    void follow(std::uint32_t s, std::uint32_t edge, std::vector<std::uint32_t>& chain) {
        const Edge& e = subject_.mesh.edges[edge];
        const bool forward = index_of(e[0]) == chain.back();
        if (!forward) {
            findings_.add(Promise::labelled, {edge_ref(edge), segment_ref(s)}, subject_.at(e[0]),
                          show("edge", edge) + " from " + show("vertex", index_of(e[0])) + " to " +
                              show("vertex", index_of(e[1])) + " is directed against " + show("segment", s));
        }
        chain.push_back(index_of(e[forward ? 1 : 0]));
    }

    void collect_sources() {
        by_source_.resize(chains_.size());
        for (std::uint32_t v = 0; v < subject_.mesh.positions.size(); ++v) {
            const VertexSource& source = subject_.mesh.vertex_sources[v];
            if (source.origin != VertexOrigin::segment || v < subject_.input_count()) continue;
            if (source.index < chains_.size()) by_source_[source.index].push_back(v);
        }
    }

    void look_up(std::uint32_t s) {
        const auto& ends = subject_.plc.segments[s];
        if (subject_.faces.has_edge(ends[0], ends[1])) {
            chains_[s] = {ends[0], ends[1]};
            return;
        }
        if (subject_.sources && !by_source_[s].empty()) {
            std::vector<std::uint32_t> chain{ends[0]};
            std::vector<std::uint32_t>& inside = by_source_[s];
            std::sort(inside.begin(), inside.end(), [&](std::uint32_t a, std::uint32_t b) {
                const int sign = forward(s, a, b);
                return sign != 0 ? sign > 0 : a < b;
            });
            chain.insert(chain.end(), inside.begin(), inside.end());
            chain.push_back(ends[1]);
            chains_[s] = std::move(chain);
            return;
        }
        walk(s);
    }

    int forward(std::uint32_t s, std::uint32_t from, std::uint32_t to) const {
        const auto& ends = subject_.plc.segments[s];
        return dot_sign(subject_.at(ends[0]), subject_.at(ends[1]), subject_.at(from), subject_.at(to));
    }

    /// From vertex to vertex along the segment, always to the nearest one that is forward and on it.
    void walk(std::uint32_t s) {
        if (neighbor_offsets_.empty()) collect_neighbors();
        const auto& ends = subject_.plc.segments[s];
        std::vector<std::uint32_t> chain{ends[0]};
        while (chain.back() != ends[1]) {
            std::uint32_t best = no_index;
            for (std::uint64_t i = neighbor_offsets_[chain.back()]; i < neighbor_offsets_[chain.back() + 1]; ++i) {
                const std::uint32_t v = neighbors_[i];
                if (v != ends[1] && v < subject_.input_count()) continue;
                if (forward(s, chain.back(), v) <= 0 || (best != no_index && forward(s, v, best) <= 0)) continue;
                if (distance_to_segment(subject_.at(v), subject_.at(ends[0]), subject_.at(ends[1])) >
                    subject_.deviation) {
                    continue;
                }
                best = v;
            }
            if (best == no_index) {
                fail(s, no_index,
                     "no mesh edge leads on along it from " + show("vertex", chain.back()) + " at " +
                         show(subject_.at(chain.back())));
                return;
            }
            chain.push_back(best);
        }
        chains_[s] = std::move(chain);
    }

    void collect_neighbors() {
        const auto vertices = static_cast<std::uint32_t>(subject_.mesh.positions.size());
        const auto for_each_pair = [&](auto&& visit) {
            for (std::uint32_t a = 0; a < vertices; ++a) {
                const auto [begin, end] = subject_.faces.upper_neighbors(a);
                for (const std::uint32_t* b = begin; b != end; ++b) {
                    visit(a, *b);
                    visit(*b, a);
                }
            }
        };
        neighbor_offsets_.assign(vertices + std::size_t{1}, 0);
        for_each_pair([&](std::uint32_t a, std::uint32_t) { ++neighbor_offsets_[a + 1]; });
        for (std::size_t v = 0; v < vertices; ++v) neighbor_offsets_[v + 1] += neighbor_offsets_[v];
        neighbors_.resize(neighbor_offsets_.back());
        std::vector<std::uint64_t> next(neighbor_offsets_.begin(), neighbor_offsets_.end() - 1);
        for_each_pair([&](std::uint32_t a, std::uint32_t b) { neighbors_[next[a]++] = b; });
    }

    void fail(std::uint32_t s, std::uint32_t edge, const std::string& what) {
        std::vector<ElementRef> elements{segment_ref(s)};
        if (edge != no_index) elements.push_back(edge_ref(edge));
        const auto& ends = subject_.plc.segments[s];
        findings_.add(Promise::conforming, std::move(elements), subject_.at(ends[0]),
                      show("segment", s) + " from " + show("vertex", ends[0]) + " to " + show("vertex", ends[1]) +
                          " is no chain of mesh edges: " + what);
    }

    const Subject& subject_;
    Findings& findings_;
    std::vector<std::vector<std::uint32_t>> chains_, by_source_;
    std::vector<std::uint64_t> offsets_, neighbor_offsets_;
    std::vector<std::uint32_t> sorted_, neighbors_;
};

/// Edges of tetrahedra, forward, near.
void check_chain(const Subject& subject, std::uint32_t s, const std::vector<std::uint32_t>& chain, Findings& findings) {
    const auto& ends = subject.plc.segments[s];
    const Point3 &a = subject.at(ends[0]), &b = subject.at(ends[1]);
    for (std::size_t i = 0; i + 1 < chain.size(); ++i) {
        const std::uint32_t v = chain[i], w = chain[i + 1];
        if (!subject.faces.has_edge(v, w)) {
            findings.add(Promise::conforming, {segment_ref(s), vertex_ref(v), vertex_ref(w)}, subject.at(v),
                         "the edge of " + show_vertices({v, w}) + " in the chain of " + show("segment", s) +
                             " is no edge of a tetrahedron");
        }
        if (dot_sign(a, b, subject.at(v), subject.at(w)) <= 0) {
            findings.add(Promise::conforming, {segment_ref(s), vertex_ref(v), vertex_ref(w)}, subject.at(v),
                         "the chain of " + show("segment", s) + " goes back from " + show("vertex", v) + " to " +
                             show("vertex", w));
        }
        if (i == 0) continue;
        const double distance = distance_to_segment(subject.at(v), a, b);
        if (!(distance <= subject.deviation)) {
            findings.add(Promise::faithful, {vertex_ref(v), segment_ref(s)}, subject.at(v),
                         show("vertex", v) + " at " + show(subject.at(v)) + " is " + show(distance) + " away from " +
                             show("segment", s) + "; expected at most " + show(subject.deviation));
        }
        if (v < subject.input_count()) {
            findings.add(Promise::conforming, {segment_ref(s), vertex_ref(v)}, subject.at(v),
                         "the chain of " + show("segment", s) + " runs through " + show("input point", v) +
                             ", which is not one of its ends");
        }
    }
}

}  // namespace

Chains check_segments(const Subject& subject, Findings& findings) {
    const std::vector<std::vector<std::uint32_t>> found = ChainFinder(subject, findings).run();
    for_each_item(found.size(), subject.control, findings, [&](std::size_t s, Findings& part) {
        check_chain(subject, static_cast<std::uint32_t>(s), found[s], part);
    });
    Chains chains;
    chains.segment_of.assign(subject.mesh.positions.size(), no_index);
    for (std::uint32_t s = 0; s < found.size(); ++s) {
        for (std::size_t i = 1; i + 1 < found[s].size(); ++i) {
            std::uint32_t& owner = chains.segment_of[found[s][i]];
            if (owner != no_index) {
                findings.add(Promise::conforming, {vertex_ref(found[s][i]), segment_ref(owner), segment_ref(s)},
                             subject.at(found[s][i]),
                             show("vertex", found[s][i]) + " is inside the chains of segments " +
                                 std::to_string(owner + 1) + " and " + std::to_string(s + 1));
            }
            owner = s;
        }
        chains.vertices.insert(chains.vertices.end(), found[s].begin(), found[s].end());
        chains.offsets.push_back(chains.vertices.size());
    }
    return chains;
}

}  // namespace certa::verify
