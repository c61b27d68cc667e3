#pragma once
// Running `conform` and judging what comes out: by the independent checker, and by what every result must satisfy.
#include <certa/conforming.h>
#include <gtest/gtest.h>

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace certa::test {

using Ids = std::vector<std::uint32_t>;

/// Appends one facet; vertices are 0-based.
void put_facet(PiecewiseLinearComplex& complex, const std::vector<Ids>& polygons,
               const std::vector<Point3>& holes = {});
/// Appends one point, segment.
std::uint32_t put_point(PiecewiseLinearComplex& complex, const Point3& p);
void put_segment(PiecewiseLinearComplex& complex, std::uint32_t a, std::uint32_t b);
/// Appends the box from `low` to `high`: 8 points, 6 facets with normals outwards.
void put_box(PiecewiseLinearComplex& complex, const Point3& low, const Point3& high);
/// Appends a complex to another one; points stay apart.
void put_complex(PiecewiseLinearComplex& complex, const PiecewiseLinearComplex& other, double scale = 1.0,
                 const Point3& offset = {});
PiecewiseLinearComplex make_box(const Point3& low, const Point3& high);

/// Sum of the volumes of the tetrahedra of a region; of all without one.
double volume_of(const TetMesh& mesh, std::uint32_t region = no_index);
/// Sum of the areas of the constraint triangles of a facet.
double area_of(const TetMesh& mesh, std::uint32_t facet);
/// Sum of the lengths of the constraint edges of a segment.
double length_of(const TetMesh& mesh, std::uint32_t segment);
std::size_t steiner_points(const ConformResult& result);
bool same_result(const ConformResult& a, const ConformResult& b);

/// What the header says about any result, done or not, that needs no geometry: arrays of equal length, indices in
/// range, input points first and unchanged, sources and statistics that agree, obstacles where it is not done and only
/// there.
void expect_well_formed(const ConformResult& result, const PiecewiseLinearComplex& complex,
                        const ConformOptions& options = {});

/// Judges a finished result by the checker.
void expect_verified(const ConformResult& result, const PiecewiseLinearComplex& complex,
                     const ConformOptions& options = {});

/// Meshes a valid complex: the outcome must be done, the result verified.
ConformResult expect_conforms(const PiecewiseLinearComplex& complex, const ConformOptions& options = {});

/// Meshes a valid complex that is hard: done and verified, or an outcome that names where it stopped.
ConformResult expect_conforms_or_says_where(const PiecewiseLinearComplex& complex, const ConformOptions& options = {});

/// The kinds of the InputError that conform answers with; an empty list, and a failed test, when it accepts.
std::vector<DefectKind> expect_refused(const PiecewiseLinearComplex& complex, const ConformOptions& options = {});

/// A family of complexes, one for each seed.
struct Family {
    std::string name;
    std::function<PiecewiseLinearComplex(std::uint64_t seed)> make;
    bool hard = false;   ///< may end in an outcome that says where
    bool sharp = false;  ///< facets meet at ten degrees or less: protecting balls are small, and many
};
/// All families of generators.h with a range of their parameters, small: up to some hundred facets.
const std::vector<Family>& small_families();

}  // namespace certa::test
