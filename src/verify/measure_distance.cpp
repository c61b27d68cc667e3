// Samples of both surfaces, by area and stratified, then the proved bounds.
//
// Sample k of n lies in the triangle where the running sum of areas passes (k + a number in [0, 1)) / n of the whole:
// each triangle gets its share of samples, at most one off. Work is cut into fixed blocks whose sums are added in
// order, so that the number of threads changes nothing.
#include <certa/distance.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "core/parallel.h"
#include "core/random.h"
#include "core/vector3.h"
#include "verify/distance_bound.h"

namespace certa {
namespace {

using verify::PolygonSurface;

struct Sums {
    double distance = 0.0, square = 0.0, largest = -1.0;
    Point3 place;
    void add(const Point3& p, double squared_distance, double weight) {
        const double d = std::sqrt(squared_distance);
        distance += weight * d;
        square += weight * squared_distance;
        if (d > largest) largest = d, place = p;
    }
    void append(const Sums& other) {
        distance += other.distance, square += other.square;
        if (other.largest > largest) largest = other.largest, place = other.place;
    }
};

/// Runs visit(item, hint, sums) over all items in blocks.
template <class Visit>
Sums sum_blocks(std::size_t count, const RunControl& control, const Visit& visit) {
    constexpr std::size_t block = 512;
    std::vector<Sums> blocks((count + block - 1) / block);
    core::parallel_for(blocks.size(), 4, control, [&](std::size_t first, std::size_t last) {
        for (std::size_t b = first; b < last && !control.cancelled(); ++b) {
            std::uint32_t hint = no_index;
            for (std::size_t i = b * block; i < std::min(count, (b + 1) * block); ++i) visit(i, hint, blocks[b]);
        }
    });
    Sums all;
    for (const Sums& sums : blocks) all.append(sums);
    return all;
}

OneSidedDistance sample(const PolygonSurface& from, const core::TriangleTree& to, const DistanceOptions& options,
                        std::uint64_t stream, const RunControl& control) {
    const std::size_t triangles = from.triangles().size(), samples = options.samples;
    std::vector<double> area_before(triangles + 1, 0.0);
    for (std::size_t t = 0; t < triangles; ++t) {
        const auto p = from.points_of_triangle(t);
        area_before[t + 1] = area_before[t] + 0.5 * norm(cross(p[1] - p[0], p[2] - p[0]));
    }
    const auto visit_sample = [&](std::size_t k, std::uint32_t& hint, Sums& sums) {
        core::Random random((options.seed * 2 + stream) * 0x100000000ull + k);
        const double goal =
            (static_cast<double>(k) + random.uniform()) / static_cast<double>(samples) * area_before.back();
        const auto after = std::upper_bound(area_before.begin() + 1, area_before.end() - 1, goal);
        const auto p = from.points_of_triangle(static_cast<std::size_t>(after - area_before.begin()) - 1);
        const double root = std::sqrt(random.uniform()), v = random.uniform();
        const Point3 x = (1.0 - root) * p[0] + (root * (1.0 - v)) * p[1] + (root * v) * p[2];
        const core::NearestPoint nearest = to.find_nearest(x, hint);
        hint = nearest.triangle;
        sums.add(x, nearest.squared_distance, 1.0);
    };
    Sums sums = sum_blocks(samples, control, visit_sample);
    std::vector<bool> is_used(from.positions().size(), false);
    for (const Triangle& t : from.triangles())
        for (const VertexId v : t) is_used[index_of(v)] = true;
    sums.append(sum_blocks(is_used.size(), control, [&](std::size_t v, std::uint32_t& hint, Sums& part) {
        if (!is_used[v]) return;
        const core::NearestPoint nearest = to.find_nearest(from.positions()[v], hint);
        hint = nearest.triangle;
        part.add(from.positions()[v], nearest.squared_distance, 0.0);
    }));
    OneSidedDistance result;
    const double count = static_cast<double>(std::max<std::size_t>(1, samples));
    result.mean = sums.distance / count;
    result.rms = std::sqrt(sums.square / count);
    result.largest = std::max(0.0, sums.largest);
    result.largest_place = sums.place;
    return result;
}

Point3 scaled(const Point3& p, int exponent) {
    return {std::ldexp(p.x, exponent), std::ldexp(p.y, exponent), std::ldexp(p.z, exponent)};
}
/// Back to the input's unit, never smaller than exact.
void rescale(OneSidedDistance& d, int exponent) {
    for (double* length : {&d.mean, &d.rms, &d.largest, &d.bound}) *length = std::ldexp(*length, exponent);
    d.largest_place = scaled(d.largest_place, exponent);
    if (d.bound > 0.0) d.bound = std::nextafter(d.bound, HUGE_VAL);
}

double diagonal_of(const PolygonSurface& surface) {
    Point3 low{HUGE_VAL, HUGE_VAL, HUGE_VAL}, high{-HUGE_VAL, -HUGE_VAL, -HUGE_VAL};
    for (std::size_t q = 0; q < surface.polygon_count(); ++q)
        for (const std::uint32_t v : surface.polygon(q)) {
            const Point3& p = surface.positions()[v];
            low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
            high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
        }
    return distance(low, high);
}

void check_input(const PolygonMesh& first, const PolygonMesh& second, const DistanceOptions& options) {
    std::vector<Defect> defects;
    const auto demand = [&](bool is_fine, const char* message) {
        if (!is_fine) defects.push_back({DefectKind::option_out_of_range, {{ElementKind::option, 0}}, {}, message});
    };
    demand(options.samples <= 1000000000, "samples must be at most 1,000,000,000");
    demand(options.tolerance > 0.0 && options.tolerance < 1.0, "tolerance must be between 0 and 1");
    demand(options.resolution.value >= 0.0 && std::isfinite(options.resolution.value),
           "resolution must be a length that is not negative");
    verify::find_polygon_defects(first, "the first surface", defects);
    verify::find_polygon_defects(second, "the second surface", defects);
    if (!defects.empty()) throw InputError(std::move(defects));
}

/// Both surfaces, cut into the triangles that are nearest to the other one.
struct Surfaces {
    Surfaces(const PolygonMesh& first, const PolygonMesh& second, const RunControl& control)
        : exponent(verify::find_exponent(first, second)), a(first, exponent), b(second, exponent) {
        tree_b.emplace(b.positions(), b.triangles());
        a.choose(*tree_b, control);
        tree_a.emplace(a.positions(), a.triangles());
        if (!b.has_choices()) return;
        b.choose(*tree_a, control);
        tree_b.emplace(b.positions(), b.triangles());
    }
    int exponent;
    PolygonSurface a, b;
    std::optional<core::TriangleTree> tree_a, tree_b;
};

}  // namespace

SurfaceDistance measure_distance(const PolygonMesh& first, const PolygonMesh& second, const DistanceOptions& options,
                                 const RunControl& control) {
    check_input(first, second, options);
    const Surfaces surfaces(first, second, control);
    const PolygonSurface &a = surfaces.a, &b = surfaces.b;
    const int exponent = surfaces.exponent;
    SurfaceDistance result;
    result.diagonal = diagonal_of(b);
    control.report("distance", 0.1);
    result.to_second = sample(a, *surfaces.tree_b, options, 0, control);
    result.to_first = sample(b, *surfaces.tree_a, options, 1, control);
    control.report("distance", 0.4);
    const auto bound = [&](OneSidedDistance& side, const PolygonSurface& from, const PolygonSurface& to,
                           const core::TriangleTree& tree) {
        if (!options.bound || control.cancelled()) return;
        verify::BoundOptions search{side.largest, options.tolerance, options.resolution.resolve(result.diagonal),
                                    options.max_pieces};
        if (!options.resolution.relative_to_diagonal) search.resolution = std::ldexp(search.resolution, -exponent);
        const verify::DistanceBound found = verify::bound_distance(from, to, tree, search, control);
        side.bound = found.bound;
        result.is_tight = result.is_tight && found.is_tight;
    };
    bound(result.to_second, a, b, *surfaces.tree_b);
    control.report("distance", 0.7);
    bound(result.to_first, b, a, *surfaces.tree_a);
    if (control.cancelled()) {
        result.outcome = Outcome::cancelled;
        return result;
    }
    control.report("distance", 1.0);
    result.diagonal = std::ldexp(result.diagonal, exponent);
    rescale(result.to_second, exponent);
    rescale(result.to_first, exponent);
    result.rms = 0.5 * (result.to_second.rms + result.to_first.rms);
    result.hausdorff = std::max(result.to_second.largest, result.to_first.largest);
    result.hausdorff_bound = std::max(result.to_second.bound, result.to_first.bound);
    return result;
}

std::vector<FarPlace> find_far_places(const PolygonMesh& first, const PolygonMesh& second, double limit,
                                      std::uint64_t max_pieces, const RunControl& control) {
    check_input(first, second, {});
    if (!(limit > 0.0)) throw InputError({{DefectKind::option_out_of_range, {}, {}, "limit must be above 0"}});
    const Surfaces surfaces(first, second, control);
    const PolygonSurface &a = surfaces.a, &b = surfaces.b;
    std::vector<FarPlace> places;
    const auto add = [&](bool is_on_first, const std::vector<verify::FarPiece>& pieces) {
        for (const verify::FarPiece& piece : pieces)
            if (places.empty() || places.back().is_on_first != is_on_first || places.back().polygon != piece.polygon ||
                places.back().nearest != piece.nearest)
                places.push_back({is_on_first, piece.polygon, piece.nearest, scaled(piece.place, surfaces.exponent)});
    };
    const double scaled_limit = std::nextafter(std::ldexp(limit, -surfaces.exponent), 0.0);
    add(true, verify::find_far_pieces(a, b, *surfaces.tree_b, scaled_limit, max_pieces, control));
    add(false, verify::find_far_pieces(b, a, *surfaces.tree_a, scaled_limit, max_pieces, control));
    return places;
}

}  // namespace certa
