// Multiplicities in the normal cycle above a vertex (thesis, Lemma 16): mu(p, h) = 1 - chi(L and x . h >= 0).
//
// L is bounded by great-circle arcs, one per face, with the solid on the side that the face's normal points away from.
// Its Euler characteristic comes from the height x . h, sweeping down from the pole: a component begins at the pole if
// it lies in L, and at each local maximum of the boundary below which L lies; two arms meet at each local minimum of
// the boundary below which L lies; the other extrema change nothing; a closed surface ends at the lower pole. Where
// wedges of the solid share an edge, L touches itself: they are swept as if apart, and the points in common taken off.
// Plan: list the arcs, visit arcs' own extrema and corners, keep the highest and lowest points to decide on the poles.
#include "curvature/link.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace certa::curvature {
namespace {

constexpr std::array<std::size_t, 3> next{1, 2, 0}, previous{2, 0, 1};

std::size_t corner_at(const std::array<Index, 3>& face, Index vertex) {
    return face[0] == vertex ? 0 : face[1] == vertex ? 1 : 2;
}

/// Turning clockwise, seen from outside, from x to y around w; in [0, 2 pi).
double clockwise(const Point3& w, const Point3& x, const Point3& y) {
    const double angle = -std::atan2(dot(w, cross(x, y)), dot(x, y));
    return angle < 0.0 ? angle + 2.0 * std::numbers::pi : angle;
}

/// Sums the changes of chi from the upper pole down to `floor` (0: the equator; -2: all).
class Sweep {
public:
    Sweep(const Point3& h, double floor) : h_(h), floor_(floor) {}

    /// The arc from `from` to `to` with the face's normal n.
    void visit_arc(const Point3& from, const Point3& to, const Point3& n) {
        const double away = dot(h_, n);
        const Point3 top = unit_or_zero(h_ - away * n);
        for (const double sign : {1.0, -1.0}) {
            const Point3 m = sign * top;
            if (!(dot(cross(from, m), n) > 0.0 && dot(cross(m, to), n) > 0.0)) continue;
            visit_extremum(dot(m, h_), sign > 0.0, away > 0.0);
        }
    }

    /// The corner w between the arc that comes from `before` and the one that goes to `after`.
    void visit_corner(const Point3& before, const Point3& w, const Point3& after) {
        const Point3 back = unit_or_zero(before - dot(before, w) * w), ahead = unit_or_zero(after - dot(after, w) * w);
        const double f = dot(w, h_), climb_back = dot(back, h_), climb_ahead = dot(ahead, h_);
        const bool is_top = climb_back <= 0.0 && climb_ahead <= 0.0,
                   is_bottom = climb_back >= 0.0 && climb_ahead >= 0.0;
        if (!is_top && !is_bottom) return;
        const double sector = clockwise(w, ahead, back);
        const Point3 up = h_ - f * w;
        const bool holds_up = clockwise(w, ahead, up) < sector;
        // At a minimum L lies below when it holds the downward direction.
        const bool holds_down = clockwise(w, ahead, -1.0 * up) < sector;
        visit_extremum(f, is_top, is_top ? !holds_up : holds_down);
    }

    /// `extra` wedges beyond the first meet at a point of this height.
    void visit_contact(double f, int extra) {
        if (f >= floor_) chi_ -= extra;
    }

    int result() const {
        int chi = chi_;
        if (seen_ && !below_highest_) ++chi;                 // the upper pole lies in L
        if (seen_ && floor_ < -1.0 && below_lowest_) ++chi;  // the lower pole
        return chi;
    }

private:
    void visit_extremum(double f, bool is_top, bool solid_below) {
        if (!seen_ || f > highest_) highest_ = f, below_highest_ = solid_below;
        if (!seen_ || f < lowest_) lowest_ = f, below_lowest_ = solid_below;
        seen_ = true;
        if (f >= floor_ && solid_below) chi_ += is_top ? 1 : -1;
    }

    Point3 h_;
    double floor_;
    int chi_ = 0;
    bool seen_ = false, below_highest_ = true, below_lowest_ = false;
    double highest_ = 0.0, lowest_ = 0.0;
};

int swept_characteristic(const Surface& surface, Index vertex, const Point3& h, double floor) {
    Sweep sweep(h, floor);
    const Point3& p = surface.positions[vertex];
    const auto direction = [&](Index v) { return unit_or_zero(surface.positions[v] - p); };
    std::vector<Index> ends;
    for (const Index f : surface.vertex_faces[vertex]) {
        const auto& face = surface.faces[f];
        const std::size_t i = corner_at(face, vertex);
        const Index from = face[next[i]], to = face[previous[i]];
        sweep.visit_arc(direction(from), direction(to), surface.face_geometry[f].normal);
        const Index g = surface.across(f, surface.face_hinges[f][next[i]]);
        const auto& other = surface.faces[g];
        sweep.visit_corner(direction(from), direction(to), direction(other[previous[corner_at(other, vertex)]]));
        ends.push_back(to);
    }
    std::sort(ends.begin(), ends.end());
    for (std::size_t i = 0, j = 0; i < ends.size(); i = j) {
        while (j < ends.size() && ends[j] == ends[i]) ++j;
        if (j - i > 1) sweep.visit_contact(dot(direction(ends[i]), h), static_cast<int>(j - i) - 1);
    }
    return sweep.result();
}

}  // namespace

bool has_solid_link(const Surface& surface, Index vertex) {
    if (vertex >= surface.used_vertices) return false;
    for (const Index f : surface.vertex_faces[vertex]) {
        const std::size_t i = corner_at(surface.faces[f], vertex);
        for (const std::size_t side : {next[i], previous[i]})
            if (surface.across(f, surface.face_hinges[f][side]) == no_index) return false;
    }
    return true;
}

int link_characteristic(const Surface& surface, Index vertex) {
    // Any direction will do that is not at a right angle to anything.
    return swept_characteristic(surface, vertex, unit_or_zero({0.5702514, 0.3193087, 0.7568393}), -2.0);
}

int upper_link_characteristic(const Surface& surface, Index vertex, const Point3& h) {
    return swept_characteristic(surface, vertex, unit_or_zero(h), 0.0);
}

}  // namespace certa::curvature
