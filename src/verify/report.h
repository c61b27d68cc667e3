#pragma once
// Collects violations: at most 100 per promise are kept, all are counted.
#include <certa/conforming.h>

#include <array>
#include <string>
#include <vector>

namespace certa::verify {

enum class Promise : unsigned char { well_formed, delaunay, conforming, faithful, labelled, gabriel };
const char* name_of(Promise promise);

class Findings {
public:
    void add(Promise promise, std::vector<ElementRef> elements, const Point3& place, std::string message);
    /// Appends `other`; in sequence this gives the same as adding to one list, however the work was divided.
    void append(Findings&& other);
    std::size_t count() const { return count_; }
    std::size_t count(Promise promise) const { return counts_[static_cast<std::size_t>(promise)]; }
    std::vector<Violation>& violations() { return violations_; }

private:
    std::vector<Violation> violations_;
    std::vector<Promise> promises_;  // parallel to violations_
    std::array<std::size_t, 6> counts_{}, kept_{};
    std::size_t count_ = 0;
};

ElementRef vertex_ref(std::uint32_t index);
ElementRef segment_ref(std::uint32_t index);
ElementRef facet_ref(std::uint32_t index);
ElementRef tetrahedron_ref(std::uint32_t index);
ElementRef triangle_ref(std::uint32_t index);
ElementRef edge_ref(std::uint32_t index);

/// "(1, 2.5, 3)", every digit that matters.
std::string show(const Point3& p);
std::string show(double value);
/// "vertices 1, 2, 3" with 1-based numbers.
std::string show_vertices(const std::vector<std::uint32_t>& vertices);
/// "kind 12", 1-based.
std::string show(const char* kind, std::uint32_t index);

}  // namespace certa::verify
