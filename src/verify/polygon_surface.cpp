// Polygons that are not planar are many surfaces: one for each way of cutting them into triangles.
//
// Up to six corners all ways are listed (1, 2, 5, 14: Catalan's numbers) whose triangles face the side of the polygon;
// larger polygons are cut by ears in the plane of Newell's normal, and the distance of the corners from that plane,
// twice, covers every other triangulation that is a graph over it.
#include "verify/polygon_surface.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "core/parallel.h"
#include "core/vector3.h"
#include "verify/report.h"

namespace certa::verify {
namespace {

constexpr std::size_t largest_listed = 6;

/// All triangulations of a polygon of n corners, as triples of corners.
using Triples = std::vector<std::array<std::uint32_t, 3>>;
std::vector<Triples> triangulate_range(std::uint32_t first, std::uint32_t last) {
    if (last - first < 2) return {{}};
    std::vector<Triples> all;
    for (std::uint32_t apex = first + 1; apex < last; ++apex)
        for (const Triples& left : triangulate_range(first, apex))
            for (const Triples& right : triangulate_range(apex, last)) {
                Triples both{{first, apex, last}};
                both.insert(both.end(), left.begin(), left.end());
                both.insert(both.end(), right.begin(), right.end());
                all.push_back(std::move(both));
            }
    return all;
}
const std::vector<Triples>& all_triangulations(std::size_t n) {
    static const std::array<std::vector<Triples>, largest_listed + 1> table = [] {
        std::array<std::vector<Triples>, largest_listed + 1> made;
        for (std::size_t i = 3; i <= largest_listed; ++i)
            made[i] = triangulate_range(0, static_cast<std::uint32_t>(i - 1));
        return made;
    }();
    return table[n];
}

Point3 newell_normal(const std::vector<Point3>& ring) {
    Point3 sum;
    for (std::size_t i = 1; i + 1 < ring.size(); ++i) sum = sum + cross(ring[i] - ring[0], ring[i + 1] - ring[0]);
    const double length = norm(sum);
    return length > 0.0 ? (1.0 / length) * sum : Point3{};
}

/// Facing the normal or, within rounding, along it.
bool faces(const Point3& a, const Point3& b, const Point3& c, const Point3& normal) {
    const double size = std::max({dot(b - a, b - a), dot(c - b, c - b), dot(a - c, a - c)});
    return dot(cross(b - a, c - a), normal) >= -1e-13 * size;
}

/// Ear clipping seen along `normal`; where no ear is left, the corner that turns most to the left is cut.
Triples clip_ears(const std::vector<Point3>& ring, const Point3& normal) {
    std::vector<std::uint32_t> left(ring.size());
    std::iota(left.begin(), left.end(), 0u);
    const auto turn = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
        return dot(cross(ring[b] - ring[a], ring[c] - ring[a]), normal);
    };
    const auto is_ear = [&](std::size_t i) {
        const std::uint32_t a = left[(i + left.size() - 1) % left.size()], b = left[i], c = left[(i + 1) % left.size()];
        if (!(turn(a, b, c) > 0.0)) return false;
        return std::none_of(left.begin(), left.end(), [&](std::uint32_t v) {
            return v != a && v != b && v != c && turn(a, b, v) >= 0.0 && turn(b, c, v) >= 0.0 && turn(c, a, v) >= 0.0;
        });
    };
    Triples triples;
    while (left.size() > 3) {
        std::size_t best = 0;
        double best_turn = -std::numeric_limits<double>::infinity();
        for (std::size_t i = 0; i < left.size(); ++i) {
            if (is_ear(i)) {
                best = i;
                break;
            }
            const double t = turn(left[(i + left.size() - 1) % left.size()], left[i], left[(i + 1) % left.size()]);
            if (t > best_turn) best = i, best_turn = t;
        }
        triples.push_back({left[(best + left.size() - 1) % left.size()], left[best], left[(best + 1) % left.size()]});
        left.erase(left.begin() + static_cast<std::ptrdiff_t>(best));
    }
    triples.push_back({left[0], left[1], left[2]});
    return triples;
}

/// Where diagonals are equally near, as in a plane, triangles with an area are preferred: counted like a distance of
/// 1e-7, coordinates being at most 1.
double needle_cost(const std::array<Point3, 3>& p) {
    const double longest = std::max({distance(p[0], p[1]), distance(p[1], p[2]), distance(p[2], p[0])});
    constexpr double thin = 0.01;
    const double shape = longest > 0.0 ? norm(cross(p[1] - p[0], p[2] - p[0])) / (longest * longest) : 0.0;
    return shape < thin ? 1e-14 * longest * (1.0 - shape / thin) : 0.0;
}

}  // namespace

void find_polygon_defects(const PolygonMesh& mesh, const std::string& name, std::vector<Defect>& defects) {
    constexpr std::size_t most = 20;
    if (mesh.offsets.size() < 2) {
        defects.push_back({DefectKind::empty_input, {}, {}, name + " has no polygon"});
        return;
    }
    for (std::uint32_t v = 0; v < mesh.positions.size() && defects.size() < most; ++v) {
        const Point3& p = mesh.positions[v];
        if (!std::isfinite(p.x) || !std::isfinite(p.y) || !std::isfinite(p.z))
            defects.push_back({DefectKind::non_finite_coordinate,
                               {vertex_ref(v)},
                               {},
                               name + ": " + show("vertex", v) + " has a coordinate that is not a finite number"});
    }
    for (std::uint32_t q = 0; q + 1 < mesh.offsets.size() && defects.size() < most; ++q) {
        const std::uint32_t begin = mesh.offsets[q], end = mesh.offsets[q + 1];
        const std::vector<ElementRef> element{{ElementKind::polygon, q}};
        if (end < begin || end > mesh.corners.size()) {
            defects.push_back({DefectKind::index_out_of_range,
                               element,
                               {},
                               name + ": the offsets of " + show("polygon", q) + " leave the array of corners"});
            return;
        }
        std::vector<std::uint32_t> ring;
        bool is_inside = true;
        for (std::uint32_t i = begin; i < end; ++i) {
            ring.push_back(index_of(mesh.corners[i]));
            is_inside = is_inside && ring.back() < mesh.positions.size();
        }
        if (!is_inside) {
            defects.push_back({DefectKind::index_out_of_range,
                               element,
                               {},
                               name + ": " + show("polygon", q) + " has a corner that is no vertex"});
            continue;
        }
        std::sort(ring.begin(), ring.end());
        if (ring.size() < 3 || std::adjacent_find(ring.begin(), ring.end()) != ring.end())
            defects.push_back(
                {DefectKind::repeated_vertex_in_polygon, element, mesh.positions[ring.empty() ? 0 : ring[0]],
                 name + ": " + show("polygon", q) + " has fewer than three different corners or one twice"});
    }
}

int find_exponent(const PolygonMesh& first, const PolygonMesh& second) {
    double largest = 0.0;
    for (const PolygonMesh* mesh : {&first, &second})
        for (const Point3& p : mesh->positions)
            largest = std::max({largest, std::abs(p.x), std::abs(p.y), std::abs(p.z)});
    int exponent = 0;
    if (largest > 0.0) std::frexp(largest, &exponent);
    return exponent;
}

PolygonSurface::PolygonSurface(const PolygonMesh& mesh, int exponent) : offsets_(mesh.offsets) {
    positions_.reserve(mesh.positions.size());
    for (const Point3& p : mesh.positions)
        positions_.push_back({std::ldexp(p.x, -exponent), std::ldexp(p.y, -exponent), std::ldexp(p.z, -exponent)});
    corners_.reserve(mesh.corners.size());
    for (const VertexId v : mesh.corners) corners_.push_back(index_of(v));
    slacks_.assign(polygon_count(), 0.0);
    chosen_.assign(polygon_count(), 0);
    for (std::size_t q = 0; q < polygon_count(); ++q) list_triangulations(q);
    connect();
    fill_triangles();
}

void PolygonSurface::connect() {
    struct Side {
        std::uint64_t key = 0;
        std::uint32_t slot = 0, polygon = 0;
        bool is_reversed = false;
    };
    std::vector<Side> sides;
    sides.reserve(corners_.size());
    for (std::uint32_t q = 0; q < polygon_count(); ++q) {
        const auto ring = polygon(q);
        for (std::uint32_t i = 0; i < ring.size(); ++i) {
            const std::uint32_t a = ring[i], b = ring[(i + 1) % ring.size()];
            sides.push_back({std::uint64_t{std::min(a, b)} << 32 | std::max(a, b), offsets_[q] + i, q, a > b});
        }
    }
    std::sort(sides.begin(), sides.end(),
              [](const Side& l, const Side& r) { return l.key != r.key ? l.key < r.key : l.slot < r.slot; });
    across_.assign(corners_.size(), no_index);
    walks_alike_.assign(corners_.size(), false);
    for (std::size_t i = 0; i < sides.size();) {
        std::size_t j = i + 1;
        while (j < sides.size() && sides[j].key == sides[i].key) ++j;
        if (j - i == 2) {
            across_[sides[i].slot] = sides[i + 1].polygon;
            across_[sides[i + 1].slot] = sides[i].polygon;
            const bool is_alike = sides[i].is_reversed == sides[i + 1].is_reversed;
            walks_alike_[sides[i].slot] = walks_alike_[sides[i + 1].slot] = is_alike;
        }
        i = j;
    }
}

void PolygonSurface::list_one(std::size_t q, const Point3& normal) {
    const auto ring = polygon(q);
    std::vector<Point3> points;
    Point3 mean;
    for (const std::uint32_t v : ring) {
        points.push_back(positions_[v]);
        mean = mean + (1.0 / static_cast<double>(ring.size())) * positions_[v];
    }
    for (const Point3& p : points) slacks_[q] = std::max(slacks_[q], 2.0 * std::abs(dot(normal, p - mean)));
    std::uint32_t next = 0;
    for (const auto& t : clip_ears(points, normal)) {
        possible_.push_back({ring[t[0]], ring[t[1]], ring[t[2]]});
        choices_.push_back(next++);
    }
}

void PolygonSurface::list_triangulations(std::size_t q) {
    const auto ring = polygon(q);
    const std::size_t n = ring.size();
    if (n == 3) {
        possible_.push_back({ring[0], ring[1], ring[2]});
        choices_.push_back(0);
    } else {
        std::vector<Point3> points;
        for (const std::uint32_t v : ring) points.push_back(positions_[v]);
        const Point3 normal = newell_normal(points);
        const std::size_t first_choice = choices_.size(), first_possible = possible_.size();
        if (n <= largest_listed) {
            for (const Triples& triples : all_triangulations(n)) {
                const bool is_fine = std::all_of(triples.begin(), triples.end(), [&](const auto& t) {
                    return faces(points[t[0]], points[t[1]], points[t[2]], normal);
                });
                if (!is_fine) continue;
                for (const auto& t : triples) {
                    const Corners corners{ring[t[0]], ring[t[1]], ring[t[2]]};
                    const auto begin = possible_.begin() + static_cast<std::ptrdiff_t>(first_possible);
                    const auto found = std::find(begin, possible_.end(), corners);
                    choices_.push_back(static_cast<std::uint32_t>(found - begin));
                    if (found == possible_.end()) possible_.push_back(corners);
                }
            }
        }
        if (choices_.size() == first_choice) list_one(q, normal);
        if (choices_.size() - first_choice > n - 2) has_choices_ = true;
    }
    possible_offsets_.push_back(static_cast<std::uint32_t>(possible_.size()));
    choice_offsets_.push_back(static_cast<std::uint32_t>(choices_.size()));
}

void PolygonSurface::fill_triangles() {
    triangles_.clear();
    polygon_of_.clear();
    for (std::uint32_t q = 0; q < polygon_count(); ++q)
        for (const std::uint32_t i : choice(q, chosen_[q])) {
            const Corners& t = possible(q)[i];
            triangles_.push_back({VertexId{t[0]}, VertexId{t[1]}, VertexId{t[2]}});
            polygon_of_.push_back(q);
        }
}

std::size_t PolygonSurface::find_best_choice(std::size_t q, const core::TriangleTree& other) const {
    std::size_t best = 0;
    double best_cost = std::numeric_limits<double>::infinity();
    const auto ring = polygon(q);
    const auto is_side = [&](std::uint32_t a, std::uint32_t b) {
        for (std::size_t i = 0; i < ring.size(); ++i)
            if (ring[i] == a && ring[(i + 1) % ring.size()] == b) return true;
        return false;
    };
    for (std::size_t k = 0; k < choice_count(q); ++k) {
        double cost = 0.0;
        for (const std::uint32_t i : choice(q, k)) {
            const Corners& t = possible(q)[i];
            cost += needle_cost(points(t));
            for (std::size_t c = 0; c < 3; ++c) {
                const std::uint32_t a = t[c], b = t[(c + 1) % 3];
                if (is_side(a, b)) continue;  // diagonals come twice, once from each side
                for (const double s : {0.25, 0.5, 0.75})
                    cost += distance(positions_[a], positions_[b]) *
                            other.find_nearest((1.0 - s) * positions_[a] + s * positions_[b]).squared_distance;
            }
        }
        if (cost < best_cost) best = k, best_cost = cost;
    }
    return best;
}

void PolygonSurface::choose(const core::TriangleTree& other, const RunControl& control) {
    if (!has_choices_) return;
    core::parallel_for(polygon_count(), 64, control, [&](std::size_t begin, std::size_t end) {
        for (std::size_t q = begin; q < end && !control.cancelled(); ++q)
            if (choice_count(q) > 1) chosen_[q] = static_cast<std::uint32_t>(find_best_choice(q, other));
    });
    fill_triangles();
}

}  // namespace certa::verify
