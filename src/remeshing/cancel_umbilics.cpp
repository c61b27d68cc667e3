// Cancelling pairs of umbilics (remesh, stage 4).
//
// Plan: pairs of opposite index, nearest first. Around the shortest way between the two, wedges within a growing radius
// are free, all others stay; features stay, too. As nothing changes on the rim, the sum of indices inside does not
// either: where it is zero, a field without umbilics can be there. The harmonic one is tried; if fewer umbilics are
// left, it is kept, else the values are put back and the disk grows.
#include "remeshing/cancel_umbilics.h"

#include <algorithm>
#include <queue>
#include <unordered_map>

#include "remeshing/connection.h"

namespace certa::remeshing {
namespace {

class PairCanceller {
public:
    PairCanceller(const WorkMesh& mesh, const Spacing& spacing, DirectionField& field, const RunControl& control)
        : mesh_(mesh), spacing_(spacing), field_(field), control_(control), laplacian_(build_laplacian(mesh)) {}

    std::size_t run() {
        std::size_t gone = 0;
        for (int round = 0; round < 16 && !control_.cancelled(); ++round) {
            const std::size_t before = gone;
            for (const Pair& pair : find_pairs()) {
                if (control_.cancelled()) break;
                if (half_turns_of(mesh_, field_, pair.wedge) > 0 && half_turns_of(mesh_, field_, pair.trisector) < 0)
                    gone += cancel(pair);
            }
            if (gone == before) break;
            field_.umbilics.clear();
            for (Index f = 0; f < mesh_.face_count(); ++f)
                if (const auto umbilic = find_umbilic(mesh_, field_, f)) field_.umbilics.push_back(*umbilic);
        }
        return gone;
    }

private:
    struct Pair {
        double distance = 0.0, spacing = 0.0;
        Index wedge = no_index, trisector = no_index;  ///< faces
    };

    Point3 place_of(const FieldUmbilic& u) const {
        Point3 p;
        for (std::size_t i = 0; i < 3; ++i) p = p + u.weights[i] * mesh_.points[mesh_.faces[u.face][i]];
        return p;
    }
    double spacing_at(Index face) const {
        double sum = 0.0;
        for (Index c = 3 * face; c < 3 * face + 3; ++c)
            sum += std::min(spacing_.at[0][mesh_.wedges[c]], spacing_.at[1][mesh_.wedges[c]]);
        return sum / 3.0;
    }
    std::vector<Pair> find_pairs() const;
    std::size_t cancel(const Pair& pair);
    std::vector<Index> way_between(const Pair& pair, double limit) const;
    /// Wedges within a distance of others over the surface, but not those at features.
    std::vector<Index> disk_around(const std::vector<Index>& wedges, double radius) const;
    void relax(const std::vector<Index>& free);
    template <class Visit>
    void visit_corners(Index wedge, const Visit& visit) const {
        Index c = mesh_.wedge_first[wedge];
        const Index first = c;
        do {
            visit(c);
            c = mesh_.next_corner(c);
        } while (c != no_index && c != first);
    }
    template <class Visit>
    void visit_neighbours(Index wedge, const Visit& visit) const {
        visit_corners(wedge, [&](Index c) {
            visit(mesh_.wedges[next_of(c)], mesh_.lengths[mesh_.edges[c]]);
            if (mesh_.next_corner(c) == no_index)
                visit(mesh_.wedges[previous_of(c)], mesh_.lengths[mesh_.edges[previous_of(c)]]);
        });
    }

    const WorkMesh& mesh_;
    const Spacing& spacing_;
    DirectionField& field_;
    const RunControl& control_;
    Laplacian laplacian_;
};

/// In order of one coordinate, so that only near ones are compared.
std::vector<PairCanceller::Pair> PairCanceller::find_pairs() const {
    struct Entry {
        Point3 place;
        double spacing;
        const FieldUmbilic* umbilic;
    };
    std::vector<Entry> entries;
    double widest = 0.0;
    for (const FieldUmbilic& u : field_.umbilics) {
        entries.push_back({place_of(u), spacing_at(u.face), &u});
        widest = std::max(widest, entries.back().spacing);
    }
    std::sort(entries.begin(), entries.end(), [](const Entry& a, const Entry& b) {
        return a.place.x != b.place.x ? a.place.x < b.place.x : a.umbilic->face < b.umbilic->face;
    });
    std::vector<Pair> pairs;
    for (std::size_t i = 0; i < entries.size(); ++i)
        for (std::size_t j = i + 1; j < entries.size() && entries[j].place.x - entries[i].place.x < widest; ++j) {
            const Entry &a = entries[i], &b = entries[j];
            if ((a.umbilic->half_turns > 0) == (b.umbilic->half_turns > 0)) continue;
            const double spacing = 0.5 * (a.spacing + b.spacing), between = distance(a.place, b.place);
            if (!(between < spacing)) continue;
            const bool first = a.umbilic->half_turns > 0;
            pairs.push_back({between, spacing, (first ? a : b).umbilic->face, (first ? b : a).umbilic->face});
        }
    std::sort(pairs.begin(), pairs.end(), [](const Pair& a, const Pair& b) {
        return a.distance != b.distance ? a.distance < b.distance : a.wedge < b.wedge;
    });
    return pairs;
}

std::vector<Index> PairCanceller::way_between(const Pair& pair, double limit) const {
    using Entry = std::pair<double, Index>;
    std::unordered_map<Index, std::pair<double, Index>> reached;  // distance, where from
    std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue;
    for (Index c = 3 * pair.wedge; c < 3 * pair.wedge + 3; ++c) {
        reached[mesh_.wedges[c]] = {0.0, no_index};
        queue.push({0.0, mesh_.wedges[c]});
    }
    const auto is_goal = [&](Index w) {
        for (Index c = 3 * pair.trisector; c < 3 * pair.trisector + 3; ++c)
            if (mesh_.wedges[c] == w) return true;
        return false;
    };
    std::vector<Index> way;
    while (!queue.empty()) {
        const auto [d, w] = queue.top();
        queue.pop();
        if (d > reached[w].first) continue;
        if (is_goal(w)) {
            for (Index at = w; at != no_index; at = reached[at].second) way.push_back(at);
            break;
        }
        visit_neighbours(w, [&, d = d, w = w](Index other, double length) {
            if (d + length > limit) return;
            const auto found = reached.find(other);
            if (found != reached.end() && found->second.first <= d + length) return;
            reached[other] = {d + length, w};
            queue.push({d + length, other});
        });
    }
    if (way.empty()) return way;
    for (const Index f : {pair.wedge, pair.trisector})
        for (Index c = 3 * f; c < 3 * f + 3; ++c)
            if (std::find(way.begin(), way.end(), mesh_.wedges[c]) == way.end()) way.push_back(mesh_.wedges[c]);
    return way;
}

std::vector<Index> PairCanceller::disk_around(const std::vector<Index>& wedges, double radius) const {
    using Entry = std::pair<double, Index>;
    std::unordered_map<Index, double> reached;
    std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue;
    for (const Index w : wedges) {
        reached[w] = 0.0;
        queue.push({0.0, w});
    }
    std::vector<Index> disk;
    while (!queue.empty()) {
        const auto [d, w] = queue.top();
        queue.pop();
        if (d > reached[w]) continue;
        const bool is_guided = !field_.guided.empty() && field_.guided[w] != not_guided;
        if (mesh_.wedge_closed[w] && !is_guided) disk.push_back(w);
        visit_neighbours(w, [&, d = d](Index other, double length) {
            if (d + length > radius) return;
            const auto found = reached.find(other);
            if (found != reached.end() && found->second <= d + length) return;
            reached[other] = d + length;
            queue.push({d + length, other});
        });
    }
    std::sort(disk.begin(), disk.end());
    disk.erase(std::unique(disk.begin(), disk.end()), disk.end());
    return disk;
}

/// The harmonic field with the directions around, of their mean strength.
void PairCanceller::relax(const std::vector<Index>& free) {
    Laplacian local;
    local.offsets.assign(1, 0);
    std::unordered_map<Index, Index> numbers;
    for (Index i = 0; i < free.size(); ++i) numbers[free[i]] = i;
    std::vector<Complex> right(free.size()), u(free.size());
    double strength = 0.0, weight = 0.0;
    for (Index i = 0; i < free.size(); ++i) {
        const Index w = free[i];
        for (std::uint64_t k = laplacian_.offsets[w]; k < laplacian_.offsets[w + 1]; ++k) {
            const auto found = numbers.find(laplacian_.columns[k]);
            if (found != numbers.end()) {
                local.columns.push_back(found->second);
                local.weights.push_back(laplacian_.weights[k]);
                local.transports.push_back(laplacian_.transports[k]);
                continue;
            }
            const Complex value = field_.squares[laplacian_.columns[k]];
            const double size = std::abs(value);
            if (!(size > 0.0)) continue;
            right[i] += laplacian_.weights[k] / size * laplacian_.transports[k] * value;
            strength += laplacian_.weights[k] * size;
            weight += laplacian_.weights[k];
        }
        local.diagonal.push_back(laplacian_.diagonal[w]);
        local.offsets.push_back(local.columns.size());
    }
    solve(local, std::vector<double>(free.size(), 0.0), right, u, {});
    const double scale = weight > 0.0 ? strength / weight : 1.0;
    for (Index i = 0; i < free.size(); ++i) field_.squares[free[i]] = std::norm(u[i]) > 1e-24 ? scale * u[i] : 1e-12;
}

std::size_t PairCanceller::cancel(const Pair& pair) {
    const std::vector<Index> way = way_between(pair, 2.0 * pair.spacing + 4.0 * mesh_.mean_edge);
    if (way.empty()) return 0;
    for (const double part : {0.25, 0.5, 1.0}) {
        const std::vector<Index> free = disk_around(way, part * pair.spacing + mesh_.mean_edge);
        if (free.empty()) continue;
        std::vector<Index> faces;
        for (const Index w : free) visit_corners(w, [&](Index c) { faces.push_back(c / 3); });
        std::sort(faces.begin(), faces.end());
        faces.erase(std::unique(faces.begin(), faces.end()), faces.end());
        const auto count = [&](int& sum) {
            std::size_t turning = 0;
            for (const Index f : faces) {
                const int turns = half_turns_of(mesh_, field_, f);
                turning += static_cast<std::size_t>(std::abs(turns));
                sum += turns;
            }
            return turning;
        };
        int sum = 0;
        const std::size_t before = count(sum);
        if (sum != 0) continue;
        std::vector<Complex> kept;
        for (const Index w : free) kept.push_back(field_.squares[w]);
        relax(free);
        spread_to_halfedges(mesh_, faces, field_);
        int sum_after = 0;
        const std::size_t after = count(sum_after);
        if (after < before) return (before - after) / 2;
        for (std::size_t i = 0; i < free.size(); ++i) field_.squares[free[i]] = kept[i];
        spread_to_halfedges(mesh_, faces, field_);
    }
    return 0;
}

}  // namespace

std::size_t cancel_umbilic_pairs(const WorkMesh& mesh, const Spacing& spacing, DirectionField& field,
                                 const RunControl& control) {
    return PairCanceller(mesh, spacing, field, control).run();
}

}  // namespace certa::remeshing
