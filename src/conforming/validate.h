#pragma once
// What a piecewise linear complex must be before `conform` touches it: every violation, with elements, place, way out.
// Decided exactly on the input's doubles; the two documented tolerances are `planarity` and `near`
// (docs/limitations.md).
#include <certa/conforming.h>

#include <span>

#include "conforming/complex.h"

namespace certa::conforming {

/// A point that lies exactly on a facet that does not list it.
struct AdoptedPoint {
    std::uint32_t point = 0, facet = 0;
};
/// A segment that lies exactly in a facet, from one point of it to another, and is no side of it.
struct AdoptedSegment {
    std::uint32_t segment = 0, facet = 0;
};

struct ValidationReport {
    std::size_t max_kept = 10'000;
    std::vector<Defect> defects;                   ///< the first max_kept, in a fixed order
    std::size_t defect_count = 0;                  ///< all
    std::vector<Defect> notes;                     ///< legal, but worth a warning: adopted points, ignored points
    std::vector<AdoptedPoint> adopted_points;      ///< isolated points that facets gain, by point, then facet
    std::vector<AdoptedSegment> adopted_segments;  ///< isolated segments that facets gain, by segment, then facet
    /// Unused points that repeat another point: they stay in the output and belong to no tetrahedron.
    std::vector<std::uint32_t> ignored_points;
    bool buildable = true;  ///< build_complex may be called: indices in range, coordinates finite

    void add(Defect defect) {
        ++defect_count;
        if (defects.size() < max_kept) defects.push_back(std::move(defect));
    }
    void append(ValidationReport other);
    bool ok() const { return defect_count == 0; }
};

/// Facets and segments of which the caller knows that they belong to one simplicial complex, such as the Delaunay
/// triangulation of the points: they cannot cross each other. Empty: nothing is known. Only facets that are single
/// triangles may be marked.
struct KnownClean {
    std::span<const std::uint8_t> facets, segments;
};

/// Indices, coordinates, duplicates, degenerate and repeated elements. O(n log n).
ValidationReport validate_structure(const PiecewiseLinearComplex& input, std::size_t max_kept = 10'000);

/// Everything about where things lie. Needs an input without structural defects, its complex and its first report.
/// Cost: O(n log n + pairs of boxes that overlap), parallel; the result does not depend on the number of threads.
ValidationReport validate_geometry(const PiecewiseLinearComplex& input, const Complex& complex,
                                   const ValidationReport& structure, const ConformOptions& options,
                                   const KnownClean& known = {}, const RunControl& control = {});

/// Both: when the structure is flawed, what can be cleaned is cleaned for the second part, so that one run names all.
ValidationReport validate(const PiecewiseLinearComplex& input, const ConformOptions& options,
                          const RunControl& control = {});

/// Adds adopted points and segments to their facets and rebuilds the incidences. Segments keep their numbers.
void adopt_elements(Complex& complex, const ValidationReport& report);

}  // namespace certa::conforming
