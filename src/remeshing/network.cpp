// Crossings by rank and chords that do not cross their family (remesh, stages 5 and 8).
//
// Plan: an edge's list is sorted by t; a new crossing goes strictly between its neighbours. A chord may leave its face
// wherever the perimeter can be reached from its entry without crossing a chord of the family: walk along the perimeter
// and jump over each such chord that is met. If the place that the field wants cannot be reached, the nearest that can
// be is taken, never on the edge of entry: there is always one.
#include "remeshing/network.h"

#include <algorithm>

#include "core/assert.h"

namespace certa::remeshing {
namespace {

/// Closer than this to a vertex, places by geometry mean nothing: the order of insertion decides.
constexpr double vertex_zone = 1e-5;

}  // namespace

Index Network::add_crossing(Index line, Index edge, double t, double low, double high) {
    std::vector<Index>& list = edge_lists_[edge];
    const auto value = [&](std::size_t i) { return crossings_[list[i]].t; };
    low = std::max(low, 0.0);
    high = std::min(high, 1.0);
    if (!(t > low && t < high)) t = 0.5 * (low + high);
    if (t < vertex_zone) {
        double inside = low;
        for (std::size_t i = 0; i < list.size() && value(i) < 2.0 * vertex_zone; ++i)
            if (value(i) < high) inside = std::max(inside, value(i));
        t = 0.5 * (inside + std::min(high, 2.0 * vertex_zone));
    } else if (t > 1.0 - vertex_zone) {
        double inside = high;
        for (std::size_t i = list.size(); i-- > 0 && value(i) > 1.0 - 2.0 * vertex_zone;)
            if (value(i) > low) inside = std::min(inside, value(i));
        t = 0.5 * (inside + std::max(low, 1.0 - 2.0 * vertex_zone));
    }
    auto at = std::lower_bound(list.begin(), list.end(), t, [&](Index c, double x) { return crossings_[c].t < x; });
    if (at != list.end() && crossings_[*at].t == t) {
        const double above = at + 1 == list.end() ? high : std::min(high, crossings_[*(at + 1)].t);
        t = 0.5 * (t + above);
        if (!(t > crossings_[*at].t && t < above)) return no_index;
        ++at;
    }
    if (!(t > low && t < high)) return no_index;
    const Index c = static_cast<Index>(crossings_.size());
    crossings_.push_back({edge, t, line, no_index});
    list.insert(at, c);
    return c;
}

Index Network::add_vertex_crossing(Index line, Index vertex) {
    crossings_.push_back({no_index, 0.0, line, vertex});
    return static_cast<Index>(crossings_.size() - 1);
}

void Network::add_chord(Index line, Index face, Index from, Index to) {
    chords_.push_back({face, line, from, to, face_heads_[face]});
    face_heads_[face] = static_cast<Index>(chords_.size() - 1);
}

PerimeterPlace Network::place(Index crossing, Index face, Index first_side) const {
    const Crossing& c = crossings_[crossing];
    for (Index side = 0; side < 3; ++side) {
        const Index h = 3 * face + (first_side + side) % 3;
        // A vertex comes before everything else on the half-edge that leaves it.
        if (c.vertex != no_index && mesh_.start_of(h) == c.vertex) return {side, mesh_.along(h) ? 0.0 : -1.0};
        if (c.vertex == no_index && mesh_.edges[h] == c.edge) return {side, mesh_.along(h) ? c.t : -c.t};
    }
    CERTA_ASSERT(!"a chord's end lies on its face");
    return {};
}

bool Network::cross(const Chord& a, const Chord& b) const {
    const PerimeterPlace a0 = place(a.from, a.face, 0), a1 = place(a.to, a.face, 0);
    const PerimeterPlace b0 = place(b.from, a.face, 0), b1 = place(b.to, a.face, 0);
    const auto& low = a0 < a1 ? a0 : a1;
    const auto& high = a0 < a1 ? a1 : a0;
    const auto within = [&](const PerimeterPlace& p) { return low < p && p < high; };
    return within(b0) != within(b1);
}

bool Network::find_exit(Family family, Index h, Index from, Index& exit, double& t, double& low, double& high) const {
    const Index face = h / 3, first = h % 3;
    struct End {
        PerimeterPlace place, partner;
    };
    std::vector<End> ends;
    for (Index c = face_heads_[face]; c != no_index; c = chords_[c].next) {
        if (family_of(chords_[c]) != family) continue;
        const PerimeterPlace a = place(chords_[c].from, face, first), b = place(chords_[c].to, face, first);
        ends.push_back({a, b});
        ends.push_back({b, a});
    }
    low = 0.0, high = 1.0;
    if (ends.empty()) return true;
    // Around the perimeter, beginning behind the entry.
    const PerimeterPlace entry = place(from, face, first);
    const auto before = [&](const PerimeterPlace& a, const PerimeterPlace& b) {
        const bool a_late = a < entry, b_late = b < entry;
        return a_late != b_late ? b_late : a < b;
    };
    std::sort(ends.begin(), ends.end(), [&](const End& a, const End& b) { return before(a.place, b.place); });
    const auto halfedge_of = [&](Index side) { return 3 * face + (first + side) % 3; };
    const auto start_key = [&](Index side) { return mesh_.along(halfedge_of(side)) ? 0.0 : -1.0; };
    const Index wanted_side = (exit % 3 + 3 - first) % 3;
    const double wanted_key = mesh_.along(exit) ? t : -t;
    double best = 1e300, key = wanted_key;
    const auto consider = [&](Index side, double key_low, double key_high) {
        if (side == 0 || !(key_low < key_high)) return;
        const bool holds = side == wanted_side && wanted_key > key_low && wanted_key < key_high;
        const double want = wanted_side + wanted_key - start_key(wanted_side), base = side - start_key(side);
        const bool above = want > base + key_low;  // the near end of the piece is its upper one
        const double miss = holds ? -1.0 : above ? want - (base + key_high) : base + key_low - want;
        if (miss >= best) return;
        best = miss;
        exit = halfedge_of(side);
        const double step = 0.1 * (key_high - key_low);
        key = holds ? wanted_key : above ? key_high - step : key_low + step;
        low = mesh_.along(exit) ? key_low : -key_high;
        high = mesh_.along(exit) ? key_high : -key_low;
    };
    const auto arc = [&](const PerimeterPlace& a, const PerimeterPlace& b) {
        const bool around = !(a < b);  // passes the start of side 0, where nothing may leave
        for (Index side = a.side; side < 3 && (around || side <= b.side); ++side)
            consider(side, side == a.side ? a.key : start_key(side),
                     !around && side == b.side ? b.key : start_key(side) + 1.0);
    };
    PerimeterPlace at = entry;
    for (std::size_t i = 0; i < ends.size();) {
        arc(at, ends[i].place);
        at = ends[i].partner;
        const auto partner = std::lower_bound(
            ends.begin(), ends.end(), at, [&](const End& e, const PerimeterPlace& p) { return before(e.place, p); });
        i = std::max(i + 1, static_cast<std::size_t>(partner - ends.begin()) + 1);
    }
    arc(at, entry);
    if (best == 1e300) return false;
    t = mesh_.along(exit) ? key : -key;
    return true;
}

void Network::erase_crossing(Index c) {
    Crossing& crossing = crossings_[c];
    if (crossing.vertex != no_index) return;
    std::vector<Index>& list = edge_lists_[crossing.edge];
    list.erase(std::find(list.begin(), list.end(), c));
    crossing.edge = no_index;
}

void Network::erase_chord(Index face, Index from, Index to) {
    for (Index* link = &face_heads_[face]; *link != no_index; link = &chords_[*link].next) {
        Chord& chord = chords_[*link];
        if (std::minmax(chord.from, chord.to) != std::minmax(from, to)) continue;
        const Index gone = *link;
        *link = chord.next;
        chords_[gone].line = no_index;
        return;
    }
}

void Network::remove_last(Index l) {
    Line& line = lines_[l];
    if (line.crossings.size() < 2) return;
    const Index to = line.crossings.back();
    line.crossings.pop_back();
    erase_chord(line.faces.back(), line.crossings.back(), to);
    line.faces.pop_back();
    erase_crossing(to);
}

void Network::remove_line(Index l) {
    Line& line = lines_[l];
    for (std::size_t k = 0; k < line.faces.size(); ++k)
        erase_chord(line.faces[k], line.crossings[k], line.crossings[(k + 1) % line.crossings.size()]);
    for (const Index c : line.crossings) erase_crossing(c);
    line.crossings.clear();
    line.faces.clear();
}

}  // namespace certa::remeshing
