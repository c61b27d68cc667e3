// What the tests of `conform` have in common (see conform_support.h): complexes in few words, laws that every result
// obeys, and the generators' families with the parameters that the tests run them with.
#include "conforming/conform_support.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <set>
#include <sstream>

#include "mesh/generators.h"

namespace certa::test {
namespace {

constexpr double degree = std::numbers::pi / 180.0;

Point3 minus(const Point3& a, const Point3& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
Point3 cross(const Point3& a, const Point3& b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
double dot(const Point3& a, const Point3& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }

std::string text_of(const ConformingCheck& check) {
    std::ostringstream text;
    text << check.violation_count << " violations";
    for (std::size_t i = 0; i < std::min<std::size_t>(3, check.violations.size()); ++i)
        text << "; " << check.violations[i].promise << ": " << check.violations[i].message;
    return text.str();
}

template <class Id>
std::uint32_t largest(const std::vector<Id>& ids) {
    std::uint32_t result = 0;
    for (const Id id : ids) result = std::max(result, index_of(id));
    return result;
}

template <class Simplex>
bool in_range(const std::vector<Simplex>& all, std::size_t count) {
    return std::all_of(all.begin(), all.end(), [&](const Simplex& s) {
        return std::all_of(s.begin(), s.end(), [&](VertexId v) { return index_of(v) < count; });
    });
}

/// Segments as docs/conventions.md numbers them: given ones first, then the other sides of facets by first appearance.
std::size_t count_segments(const PiecewiseLinearComplex& c) {
    std::set<std::array<std::uint32_t, 2>> seen;
    const auto add = [&](VertexId a, VertexId b) {
        seen.insert({std::min(index_of(a), index_of(b)), std::max(index_of(a), index_of(b))});
    };
    for (const Edge& e : c.segments) add(e[0], e[1]);
    for (std::size_t p = 0; p < c.polygon_count(); ++p) {
        const std::uint32_t first = c.polygon_offsets[p], last = c.polygon_offsets[p + 1];
        for (std::uint32_t i = first; i < last && last - first > 1; ++i)
            add(c.corners[i], c.corners[i + 1 == last ? first : i + 1]);
    }
    return seen.size();
}

}  // namespace

void put_facet(PiecewiseLinearComplex& complex, const std::vector<Ids>& polygons, const std::vector<Point3>& holes) {
    std::vector<std::vector<VertexId>> rings;
    for (const Ids& polygon : polygons) {
        auto& ring = rings.emplace_back();
        for (const std::uint32_t v : polygon) ring.push_back(VertexId{v});
    }
    add_facet(complex, rings, holes);
}

std::uint32_t put_point(PiecewiseLinearComplex& complex, const Point3& p) {
    complex.positions.push_back(p);
    return static_cast<std::uint32_t>(complex.positions.size() - 1);
}

void put_segment(PiecewiseLinearComplex& complex, std::uint32_t a, std::uint32_t b) {
    complex.segments.push_back({VertexId{a}, VertexId{b}});
}

void put_box(PiecewiseLinearComplex& complex, const Point3& low, const Point3& high) {
    const auto at = static_cast<std::uint32_t>(complex.positions.size());
    for (int i = 0; i < 8; ++i)
        put_point(complex,
                  {(i & 1) != 0 ? high.x : low.x, (i & 2) != 0 ? high.y : low.y, (i & 4) != 0 ? high.z : low.z});
    for (const std::array<std::uint32_t, 4>& f : {std::array<std::uint32_t, 4>{0, 2, 3, 1},
                                                  {4, 5, 7, 6},
                                                  {0, 1, 5, 4},
                                                  {1, 3, 7, 5},
                                                  {3, 2, 6, 7},
                                                  {2, 0, 4, 6}})
        put_facet(complex, {{at + f[0], at + f[1], at + f[2], at + f[3]}});
}

PiecewiseLinearComplex make_box(const Point3& low, const Point3& high) {
    PiecewiseLinearComplex complex;
    put_box(complex, low, high);
    return complex;
}

void put_complex(PiecewiseLinearComplex& complex, const PiecewiseLinearComplex& other, double scale,
                 const Point3& offset) {
    const auto first = static_cast<std::uint32_t>(complex.positions.size());
    const auto moved = [&](const Point3& p) {
        return Point3{scale * p.x + offset.x, scale * p.y + offset.y, scale * p.z + offset.z};
    };
    for (const Point3& p : other.positions) complex.positions.push_back(moved(p));
    for (const Edge& e : other.segments) put_segment(complex, first + index_of(e[0]), first + index_of(e[1]));
    for (std::size_t f = 0; f < other.facet_count(); ++f) {
        std::vector<Ids> polygons;
        for (std::uint32_t p = other.facet_offsets[f]; p < other.facet_offsets[f + 1]; ++p) {
            Ids& polygon = polygons.emplace_back();
            for (std::uint32_t i = other.polygon_offsets[p]; i < other.polygon_offsets[p + 1]; ++i)
                polygon.push_back(first + index_of(other.corners[i]));
        }
        std::vector<Point3> holes;
        for (std::uint32_t h = other.hole_offsets[f]; h < other.hole_offsets[f + 1]; ++h)
            holes.push_back(moved(other.facet_holes[h]));
        put_facet(complex, polygons, holes);
    }
}

double volume_of(const TetMesh& mesh, std::uint32_t region) {
    double sum = 0.0;
    for (std::size_t t = 0; t < mesh.tetrahedra.size(); ++t) {
        if (region != no_index && index_of(mesh.tetrahedron_regions[t]) != region) continue;
        const auto at = [&](int i) { return mesh.positions[index_of(mesh.tetrahedra[t][i])]; };
        sum += dot(cross(minus(at(1), at(0)), minus(at(2), at(0))), minus(at(3), at(0))) / 6.0;
    }
    return sum;
}

double area_of(const TetMesh& mesh, std::uint32_t facet) {
    double sum = 0.0;
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
        if (index_of(mesh.triangle_facets[t]) != facet) continue;
        const auto at = [&](int i) { return mesh.positions[index_of(mesh.triangles[t][i])]; };
        const Point3 n = cross(minus(at(1), at(0)), minus(at(2), at(0)));
        sum += 0.5 * std::sqrt(dot(n, n));
    }
    return sum;
}

double length_of(const TetMesh& mesh, std::uint32_t segment) {
    double sum = 0.0;
    for (std::size_t e = 0; e < mesh.edges.size(); ++e) {
        if (index_of(mesh.edge_segments[e]) != segment) continue;
        const Point3 d = minus(mesh.positions[index_of(mesh.edges[e][1])], mesh.positions[index_of(mesh.edges[e][0])]);
        sum += std::sqrt(dot(d, d));
    }
    return sum;
}

std::size_t steiner_points(const ConformResult& result) {
    return result.mesh.positions.size() - result.statistics.input_points;
}

bool same_result(const ConformResult& a, const ConformResult& b) {
    const TetMesh &m = a.mesh, &n = b.mesh;
    return a.outcome == b.outcome && m.positions == n.positions && m.vertex_sources == n.vertex_sources &&
           m.tetrahedra == n.tetrahedra && m.tetrahedron_regions == n.tetrahedron_regions &&
           m.triangles == n.triangles && m.triangle_facets == n.triangle_facets && m.edges == n.edges &&
           m.edge_segments == n.edge_segments && a.segments == b.segments &&
           a.region_attributes == b.region_attributes && a.obstacles.size() == b.obstacles.size() &&
           a.warnings.size() == b.warnings.size();
}

namespace {

void expect_obstacles_say_where(const ConformResult& result, const PiecewiseLinearComplex& complex) {
    Point3 low = complex.positions[0], high = low;
    for (const Point3& p : complex.positions) {
        low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
        high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
    }
    const Point3 d = minus(high, low);
    const double room = 1e-9 * (std::sqrt(dot(d, d)) + std::abs(low.x) + std::abs(low.y) + std::abs(low.z));
    for (const Defect& o : result.obstacles) {
        EXPECT_FALSE(o.message.empty());
        EXPECT_FALSE(o.elements.empty()) << o.message;
        EXPECT_TRUE(o.place.x >= low.x - room && o.place.x <= high.x + room && o.place.y >= low.y - room &&
                    o.place.y <= high.y + room && o.place.z >= low.z - room && o.place.z <= high.z + room)
            << o.message;
        for (const ElementRef& e : o.elements) {
            if (e.kind == ElementKind::facet) {
                EXPECT_LT(e.index, complex.facet_count()) << o.message;
            }
        }
    }
}

}  // namespace

void expect_well_formed(const ConformResult& result, const PiecewiseLinearComplex& complex,
                        const ConformOptions& options) {
    const TetMesh& mesh = result.mesh;
    if (result.outcome == Outcome::done) {
        EXPECT_TRUE(result.obstacles.empty());
    } else if (result.outcome != Outcome::cancelled) {
        EXPECT_FALSE(result.obstacles.empty()) << name_of(result.outcome) << " without a place";
        expect_obstacles_say_where(result, complex);
    }
    if (result.outcome != Outcome::done && mesh.positions.empty()) return;
    ASSERT_GE(mesh.positions.size(), complex.positions.size());
    EXPECT_TRUE(std::equal(complex.positions.begin(), complex.positions.end(), mesh.positions.begin()));
    ASSERT_EQ(mesh.vertex_sources.size(), mesh.positions.size());
    const std::size_t segments = count_segments(complex);
    std::size_t on_segments = 0, in_facets = 0;
    for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
        const VertexSource& source = mesh.vertex_sources[v];
        ASSERT_EQ(source.origin == VertexOrigin::input, v < complex.positions.size()) << "vertex " << v;
        on_segments += source.origin == VertexOrigin::segment ? 1 : 0;
        in_facets += source.origin == VertexOrigin::facet ? 1 : 0;
        const std::size_t bound = source.origin == VertexOrigin::input     ? complex.positions.size()
                                  : source.origin == VertexOrigin::segment ? segments
                                                                           : complex.facet_count();
        EXPECT_LT(source.index, bound) << "source of vertex " << v;
    }
    EXPECT_EQ(result.statistics.input_points, complex.positions.size());
    EXPECT_EQ(result.statistics.steiner_on_segments, on_segments);
    EXPECT_EQ(result.statistics.steiner_in_facets, in_facets);
    ASSERT_EQ(mesh.tetrahedron_regions.size(), mesh.tetrahedra.size());
    ASSERT_EQ(mesh.triangle_facets.size(), mesh.triangles.size());
    ASSERT_EQ(mesh.edge_segments.size(), mesh.edges.size());
    EXPECT_TRUE(in_range(mesh.tetrahedra, mesh.positions.size()));
    EXPECT_TRUE(in_range(mesh.triangles, mesh.positions.size()));
    EXPECT_TRUE(in_range(mesh.edges, mesh.positions.size()));
    EXPECT_EQ(result.segments.size(), segments);
    EXPECT_TRUE(mesh.triangles.empty() || largest(mesh.triangle_facets) < complex.facet_count());
    EXPECT_TRUE(mesh.edges.empty() || largest(mesh.edge_segments) < result.segments.size());
    if (result.outcome == Outcome::done) {
        // Merging drops sides between facets: these have no edges.
        if (!options.merge_coplanar) {
            EXPECT_LE(result.segments.size(), mesh.edges.size());
        }
        if (options.max_points) {
            EXPECT_LE(mesh.positions.size(), *options.max_points);
        }
        EXPECT_GT(mesh.tetrahedra.size(), 0u);
        EXPECT_GT(result.region_attributes.size(), largest(mesh.tetrahedron_regions));
    }
}

void expect_verified(const ConformResult& result, const PiecewiseLinearComplex& complex,
                     const ConformOptions& options) {
    ConformingCheckOptions check_options;
    check_options.gabriel = options.gabriel;
    check_options.merge_coplanar = options.merge_coplanar;
    check_options.planarity = options.planarity;
    const ConformingCheck check = check_conforming(result.mesh, complex, check_options);
    EXPECT_TRUE(check.ok()) << text_of(check);
    EXPECT_EQ(check.tetrahedra_checked, result.mesh.tetrahedra.size());
}

ConformResult expect_conforms(const PiecewiseLinearComplex& complex, const ConformOptions& options) {
    ConformResult result = expect_conforms_or_says_where(complex, options);
    EXPECT_EQ(result.outcome, Outcome::done)
        << name_of(result.outcome) << (result.obstacles.empty() ? "" : ": " + result.obstacles[0].message);
    return result;
}

ConformResult expect_conforms_or_says_where(const PiecewiseLinearComplex& complex, const ConformOptions& options) {
    try {
        ConformOptions bounded = options;
        // A bound far above what any of these cases needs: an endless refinement ends as a failed test.
        if (!bounded.max_points) bounded.max_points = 20'000 + 200 * complex.positions.size();
        ConformResult result = conform(complex, bounded);
        expect_well_formed(result, complex, bounded);
        if (result.outcome == Outcome::done) expect_verified(result, complex, options);
        return result;
    } catch (const InputError& error) {
        ADD_FAILURE() << "refused: " << error.what();
    } catch (const InternalError& error) {
        ADD_FAILURE() << "internal error: " << error.what();
    }
    ConformResult failed;
    failed.outcome = Outcome::undecided;
    failed.statistics.input_points = complex.positions.size();
    failed.mesh.positions = complex.positions;
    return failed;
}

std::vector<DefectKind> expect_refused(const PiecewiseLinearComplex& complex, const ConformOptions& options) {
    std::vector<DefectKind> kinds;
    try {
        conform(complex, options);
        ADD_FAILURE() << "accepted";
    } catch (const InputError& error) {
        EXPECT_FALSE(error.defects().empty());
        for (const Defect& defect : error.defects()) {
            EXPECT_FALSE(defect.message.empty());
            kinds.push_back(defect.kind);
        }
    }
    std::sort(kinds.begin(), kinds.end());
    kinds.erase(std::unique(kinds.begin(), kinds.end()), kinds.end());
    return kinds;
}

namespace {

/// Flat complexes bound no volume: two points off the plane make one.
PiecewiseLinearComplex lifted(PiecewiseLinearComplex complex, std::uint64_t seed) {
    put_point(complex, {0.4 + 0.01 * static_cast<double>(seed % 10), 0.6, 0.5});
    put_point(complex, {0.6, 0.3, -0.7});
    return complex;
}

std::vector<Family> make_small_families() {
    using namespace generators;
    std::vector<Family> all;
    const auto small = [](std::uint64_t seed, std::uint32_t low, std::uint32_t high) {
        return low + static_cast<std::uint32_t>((seed * 2654435761u >> 7) % (high - low + 1));
    };
    for (const double angle : {360.0, 90.0, 10.0, 1.0, 0.1, 0.01, 0.001}) {
        const double width = angle * degree;
        const bool sharp = angle <= 10.0;
        const std::string at = " " + std::to_string(angle);
        all.push_back({"fan" + at, [=](std::uint64_t s) { return make_fan(small(s, 2, 14), width, s); }, false, sharp});
        all.push_back(
            {"book" + at, [=](std::uint64_t s) { return make_book(small(s, 2, 14), 0.9 * width); }, false, sharp});
        all.push_back({"wedge" + at,
                       [=](std::uint64_t s) { return make_wedge(0.45 * width / (1 + s % 50), s % 2 == 0); }, false,
                       sharp});
        if (width < 2) {
            all.push_back(
                {"cone" + at, [=](std::uint64_t s) { return make_cone(small(s, 2, 9), width, s); }, true, sharp});
        }
    }
    all.push_back({"star 1", [=](std::uint64_t s) { return make_star(small(s, 3, 60), 1.0, s); }});
    all.push_back({"star 3", [=](std::uint64_t s) { return make_star(small(s, 3, 40), 3.0, s); }});
    all.push_back({"umbrella", [=](std::uint64_t s) { return make_umbrella(small(s, 5, 24), s); }});
    all.push_back({"cube", [=](std::uint64_t s) { return make_cube(small(s, 1, 5), false); }});
    all.push_back({"cube of triangles", [=](std::uint64_t s) { return make_cube(small(s, 1, 5), true); }});
    all.push_back({"nested", [=](std::uint64_t s) { return make_nested_cubes(small(s, 1, 8)); }});
    all.push_back({"plate", [=](std::uint64_t s) {
                       return lifted(make_plate(small(s, 0, 12), small(s + 1, 0, 6), small(s + 2, 0, 5), s), s);
                   }});
    all.push_back({"near 1e-3", [](std::uint64_t s) { return make_near_facets(1e-3, s); }});
    all.push_back({"near 1e-6", [](std::uint64_t s) { return make_near_facets(1e-6, s); }, true});
    all.push_back({"coplanar", [=](std::uint64_t s) { return lifted(make_coplanar_facets(small(s, 1, 5), s), s); }});
    all.push_back({"glued", [=](std::uint64_t s) { return make_glued_tetrahedra(small(s, 1, 40), s); }});
    for (const double height : {1.0, 1e-2, 1e-4}) {
        all.push_back({"flat cloud " + std::to_string(height),
                       [=](std::uint64_t s) { return make_flat_cloud(small(s, 4, 30), height, s); }, true});
    }
    all.push_back({"soup", [=](std::uint64_t s) { return make_soup(small(s, 2, 40), s); }});
    all.push_back({"mixture", [](std::uint64_t s) { return make_mixture(s); }});
    all.push_back({"geology", [=](std::uint64_t s) { return make_geology(small(s, 3, 7), small(s + 1, 1, 4), s); }});
    return all;
}

}  // namespace

const std::vector<Family>& small_families() {
    static const std::vector<Family> all = make_small_families();
    return all;
}

}  // namespace certa::test
