// A front that carries the nearest segment instead of a distance (remesh, stage 6).
//
// Each wedge knows one segment and the straight distance to it, the same chord that the spacing is reckoned in. Handing
// a segment over to a neighbour, the walk along its line to the nearest one there keeps it exact. The front runs over
// the surface and stops at features: no false neighbours across thin walls. Values only fall, and by a finite amount.
#include "remeshing/proximity.h"

#include <algorithm>
#include <functional>

namespace certa::remeshing {
namespace {

double distance_to(const Point3& p, const Segment& s) {
    const Point3 d = s.b - s.a, e = p - s.a;
    const double length = dot(d, d);
    const double t = length > 0.0 ? std::clamp(dot(e, d) / length, 0.0, 1.0) : 0.0;
    return norm(e - t * d);
}

}  // namespace

double Proximity::descend(const Point3& point, Index& segment) const {
    double best = distance_to(point, segments_[segment]);
    for (int guard = 0; guard < 64; ++guard) {
        const Index here = segment;
        for (const Index n : {segments_[here].previous, segments_[here].next}) {
            if (n == no_index) continue;
            const double d = distance_to(point, segments_[n]);
            if (d < best) best = d, segment = n;
        }
        if (segment == here) break;
    }
    return best;
}

bool Proximity::offer(Index wedge, Index segment) {
    const double d = descend(mesh_.points[mesh_.wedge_vertices[wedge]], segment);
    if (!(d < distances_[wedge] * (1.0 - 1e-9)) || d > reach_ * spacing_[wedge]) return false;
    distances_[wedge] = d;
    sources_[wedge] = segment;
    heap_.push_back({d, wedge});
    std::push_heap(heap_.begin(), heap_.end(), std::greater<>());
    return true;
}

Index Proximity::add(const Segment& segment, Index face, Index previous) {
    const Index number = static_cast<Index>(segments_.size());
    segments_.push_back(segment);
    segments_.back().previous = previous;
    if (previous != no_index) segments_[previous].next = number;
    for (Index i = 0; i < 3; ++i) {
        const Index w = mesh_.wedges[3 * face + i];
        const double d = distance_to(mesh_.points[mesh_.wedge_vertices[w]], segment);
        if (!(d < distances_[w])) continue;
        distances_[w] = d;
        sources_[w] = number;
        heap_.push_back({d, w});
        std::push_heap(heap_.begin(), heap_.end(), std::greater<>());
    }
    return number;
}

void Proximity::spread() {
    changed_.clear();
    while (!heap_.empty()) {
        const auto [d, w] = heap_.front();
        std::pop_heap(heap_.begin(), heap_.end(), std::greater<>());
        heap_.pop_back();
        if (d > distances_[w]) continue;
        changed_.push_back(w);
        Index c = mesh_.wedge_first[w];
        const Index first = c;
        do {
            offer(mesh_.wedges[next_of(c)], sources_[w]);
            const Index n = mesh_.next_corner(c);
            if (n == no_index) offer(mesh_.wedges[previous_of(c)], sources_[w]);
            c = n;
        } while (c != no_index && c != first);
    }
}

double Proximity::distance_from(const Point3& point, Index face) const {
    double best = 1e300;
    for (Index i = 0; i < 3; ++i) {
        Index s = sources_[mesh_.wedges[3 * face + i]];
        if (s != no_index) best = std::min(best, descend(point, s));
    }
    return best;
}

}  // namespace certa::remeshing
