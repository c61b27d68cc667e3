// Rings are counted in facets: first what the culprit itself is made of, then everything that shares a vertex with it,
// and so on. Each call adds something or says that nothing is left to add, so a run restarts finitely often.
#include "conforming/growth.h"

namespace certa::conforming {
namespace {

class Ring {
public:
    Ring(ProtectedSet& set, const Complex& complex, bool with_segments)
        : set_(set), complex_(complex), with_segments_(with_segments), seen_(complex.points.size(), 0) {}

    void start(const ElementRef& element) {
        if (element.kind == ElementKind::segment) {
            add_segment(element.index);
        } else if (element.kind == ElementKind::facet) {
            add_facet(element.index);
        } else if (element.kind == ElementKind::vertex && element.index < complex_.points.size()) {
            add_vertex(element.index);
        }
    }

    /// Everything that shares a vertex with the ring so far; false when that is nothing new.
    bool widen() {
        const std::vector<std::uint32_t> vertices = std::move(front_);
        front_.clear();
        for (const std::uint32_t v : vertices) {
            for (const std::uint32_t s : complex_.point_segments[v]) add_segment(s);
            for (const std::uint32_t f : complex_.point_facets[v]) add_facet(f);
        }
        return !front_.empty();
    }

    bool changed() const { return changed_; }

private:
    ProtectedSet& set_;
    const Complex& complex_;
    bool with_segments_;
    std::vector<std::uint8_t> seen_;
    std::vector<std::uint32_t> front_;
    bool changed_ = false;

    void add_vertex(std::uint32_t v) {
        if (seen_[v] == 0) {
            seen_[v] = 1;
            front_.push_back(v);
        }
        if (set_.vertices[v] == 0) {
            set_.vertices[v] = 1;
            changed_ = true;
        }
    }
    void add_segment(std::uint32_t s) {
        for (const std::uint32_t v : complex_.segments[s]) add_vertex(v);
        if (with_segments_ && set_.segments[s] == 0) {
            set_.segments[s] = 1;
            changed_ = true;
        }
    }
    void add_facet(std::uint32_t f) {
        for (const Side& side : complex_.facet_sides[f]) add_segment(side.segment);
    }
};

}  // namespace

bool grow_protected_set(ProtectedSet& set, const Complex& complex, const std::vector<Obstruction>& obstructions) {
    // Balls around vertices are few; along segments they may be many.
    for (const bool with_segments : {false, true}) {
        Ring ring(set, complex, with_segments);
        for (const Obstruction& o : obstructions) {
            ring.start(o.element);
            if (o.vertex != no_index) ring.start({ElementKind::vertex, o.vertex});
        }
        if (ring.changed()) return true;
        while (with_segments && !ring.changed() && ring.widen()) {
        }
        if (ring.changed()) return true;
    }
    return false;
}

}  // namespace certa::conforming
