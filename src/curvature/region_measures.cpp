// The measures of one region: edges by the length inside, triangles by the area inside, vertices by membership.
//
// A set of faces has no thickness: an edge is seen from each of its two faces, and counts half from each (rim half),
// when either sees it inside (closed), or when both do (open); a vertex counts by the share of angle of the faces that
// see it inside. Predicates are bisected: a segment or triangle is cut until its corners and middle agree, at least
// three times and at most down to the tolerance; what is left undecided counts by its middle and is reported. Faces are
// worked on in blocks whose sums are added in order: the same result for any number of threads.
#include <algorithm>
#include <cmath>

#include "core/parallel.h"
#include "curvature/bound.h"
#include "curvature/estimators.h"
#include "curvature/link.h"
#include "curvature/region.h"

namespace certa {
namespace curvature {
namespace {

constexpr std::array<std::size_t, 3> next{1, 2, 0}, previous{2, 0, 1};

class RegionMeasurer {
public:
    RegionMeasurer(const Surface& surface, const Cells& cells, const CompiledRegion& region, Rim rim, double tolerance)
        : surface_(surface), cells_(cells), region_(region), rim_(rim), tolerance_(tolerance) {}

    /// The face's area, the hinges whose left face it is, the vertices whose first face it is. True if it meets.
    bool add_face(Sums& sums, double& undecided, Index f) {
        const auto& corners = surface_.faces[f];
        const double area = region_.has_predicates() ? bisected_area(f, undecided) : region_.area_inside(f);
        sums.area += area;
        for (std::size_t i = 0; i < 3; ++i) {
            const Index h = surface_.face_hinges[f][i];
            if (surface_.hinges[h].left == f) add_hinge(sums, surface_.hinges[h]);
            if (surface_.vertex_faces[corners[i]].front() == f) add_vertex(sums, corners[i]);
        }
        return area > 0.0 || (surface_.face_geometry[f].area == 0.0 && region_.holds(middle_of(f), f));
    }

private:
    Point3 middle_of(Index f) const {
        const auto& v = surface_.faces[f];
        return (1.0 / 3.0) * (surface_.positions[v[0]] + surface_.positions[v[1]] + surface_.positions[v[2]]);
    }

    double share(bool left, bool right) const {
        if (rim_ == Rim::closed) return left || right ? 1.0 : 0.0;
        if (rim_ == Rim::open) return left && right ? 1.0 : 0.0;
        return 0.5 * (static_cast<double>(left) + static_cast<double>(right));
    }

    double share_at(const Hinge& hinge, const Point3& p) const {
        if (!region_.has_faces()) return region_.holds(p, no_index) ? 1.0 : 0.0;
        return share(region_.holds(p, hinge.left), region_.holds(p, hinge.right));
    }

    double part_inside(const Hinge& hinge) {
        const Point3 &a = surface_.positions[hinge.a], &b = surface_.positions[hinge.b];
        region_.crossings(a, b, parameters_);
        parameters_.insert(parameters_.begin(), 0.0);
        parameters_.push_back(1.0);
        double inside = 0.0;
        for (std::size_t k = 0; k + 1 < parameters_.size(); ++k) {
            const double from = parameters_[k], to = parameters_[k + 1];
            if (!(to > from)) continue;
            if (region_.has_predicates())
                inside += bisected_part(hinge, a, b, from, to, 0);
            else
                inside += (to - from) * share_at(hinge, a + 0.5 * (from + to) * (b - a));
        }
        return inside;
    }

    double bisected_part(const Hinge& hinge, const Point3& a, const Point3& b, double from, double to,
                         int depth) const {
        const double middle = 0.5 * (from + to), width = to - from;
        const auto at = [&](double t) { return share_at(hinge, a + t * (b - a)); };
        // Ends may lie on the border of another primitive: look just inside.
        const double first = at(from + 1e-9 * width), centre = at(middle), last = at(to - 1e-9 * width);
        const bool small = width * hinge.length <= tolerance_ || depth > 40;
        if (small || (depth >= 3 && first == centre && centre == last)) return width * centre;
        return bisected_part(hinge, a, b, from, middle, depth + 1) + bisected_part(hinge, a, b, middle, to, depth + 1);
    }

    double bisected_area(Index f, double& undecided) const {
        const auto& v = surface_.faces[f];
        return bisected_area(f, {surface_.positions[v[0]], surface_.positions[v[1]], surface_.positions[v[2]]},
                             surface_.face_geometry[f].area, 0, undecided);
    }

    double bisected_area(Index f, const std::array<Point3, 3>& p, double area, int depth, double& undecided) const {
        if (area == 0.0) return 0.0;
        const Point3 centre = (1.0 / 3.0) * (p[0] + p[1] + p[2]);
        const bool inside = region_.holds(centre, f);
        bool agree = true;
        for (const Point3& corner : p)
            agree = agree && region_.holds(centre + (1.0 - 1e-9) * (corner - centre), f) == inside;
        const double size = std::max({distance(p[0], p[1]), distance(p[1], p[2]), distance(p[2], p[0])});
        if (depth >= 3 && agree) return inside ? area : 0.0;
        if (size <= tolerance_ || depth > 20) {
            if (!agree) undecided += area;
            return inside ? area : 0.0;
        }
        const std::array<Point3, 3> m{0.5 * (p[1] + p[2]), 0.5 * (p[2] + p[0]), 0.5 * (p[0] + p[1])};
        const double quarter = 0.25 * area;
        double sum = bisected_area(f, m, quarter, depth + 1, undecided);
        for (std::size_t i = 0; i < 3; ++i)
            sum += bisected_area(f, {p[i], m[previous[i]], m[next[i]]}, quarter, depth + 1, undecided);
        return sum;
    }

    void add_hinge(Sums& sums, const Hinge& hinge) {
        if (hinge.angle == 0.0) return;
        const double length = hinge.length * part_inside(hinge);
        if (length == 0.0) return;
        const EdgeTensors tensors = hinge_tensors(surface_, hinge);
        add(sums.swapped, length, tensors.swapped);
        add(sums.plain, length, tensors.plain);
        sums.edge_mass += length * std::abs(hinge.angle);
    }

    void add_vertex(Sums& sums, Index v) {
        const Point3& p = surface_.positions[v];
        double weight = 0.0;
        if (!region_.has_faces()) {
            weight = region_.holds(p, no_index) ? 1.0 : 0.0;
        } else {
            bool any = false, all = true;
            double angles = 0.0;
            for (const Index f : surface_.vertex_faces[v]) {
                const bool inside = region_.holds(p, f);
                any = any || inside, all = all && inside;
                const auto& face = surface_.faces[f];
                if (inside) angles += surface_.face_angles[f][face[0] == v ? 0 : face[1] == v ? 1 : 2];
            }
            weight = all                   ? 1.0
                     : rim_ == Rim::closed ? static_cast<double>(any)
                     : rim_ == Rim::open   ? 0.0
                                           : angles / surface_.angle_sums[v];
        }
        sums.gaussian += weight * surface_.defects[v];
        sums.vertex_mass += weight * cells_.remainders[v].vertex_mass;
    }

    const Surface& surface_;
    const Cells& cells_;
    const CompiledRegion& region_;
    Rim rim_;
    double tolerance_;
    std::vector<double> parameters_;
};

struct Block {
    Sums sums;
    double undecided = 0.0;
    std::vector<Index> faces;
};

/// Largest principal curvature over the vertices of some faces, from 2-ring dual cells.
double estimate_curvature(const Surface& surface, const Cells& cells, const std::vector<Index>& faces) {
    RingWalker walker(surface, cells);
    Marks seen(surface.positions.size());
    seen.clear();
    double largest = 0.0;
    for (const Index f : faces)
        for (const Index v : surface.faces[f]) {
            if (!seen.mark(v)) continue;
            const Sums sums = walker.sum(v, 2, Rim::dual);
            const Principal principal = compute_principal(sums, surface.normals[v]);
            largest = std::max({largest, std::abs(principal.k_min), std::abs(principal.k_max)});
        }
    return largest;
}

void require_valid(const RegionOptions& options) {
    const auto refuse = [](const char* message) {
        throw InputError({{DefectKind::option_out_of_range, {{ElementKind::option, 0}}, {}, message}});
    };
    if (options.rim == Rim::dual) refuse("the rim of a region is half, closed or open");
    if (!(options.tolerance.value > 0.0) || !std::isfinite(options.tolerance.value))
        refuse("tolerance must be above 0");
    if (options.max_curvature && (!(*options.max_curvature > 0.0) || !std::isfinite(*options.max_curvature)))
        refuse("max_curvature must be above 0");
}

}  // namespace

Sums measure_region(const Surface& surface, const Cells& cells, const CompiledRegion& region, Rim rim, double tolerance,
                    double& undecided, std::vector<Index>& faces, const RunControl& control) {
    constexpr std::size_t size = 2048;
    const std::size_t count = surface.faces.size();
    std::vector<Block> blocks((count + size - 1) / size);
    core::parallel_for(blocks.size(), 1, control, [&](std::size_t begin, std::size_t end) {
        RegionMeasurer measurer(surface, cells, region, rim, tolerance);
        for (std::size_t b = begin; b < end; ++b) {
            if (control.cancelled()) return;
            for (std::size_t f = b * size; f < std::min(count, (b + 1) * size); ++f)
                if (measurer.add_face(blocks[b].sums, blocks[b].undecided, static_cast<Index>(f)))
                    blocks[b].faces.push_back(static_cast<Index>(f));
        }
    });
    Sums total;
    for (const Block& block : blocks) {
        const Sums& part = block.sums;
        add(total.swapped, 1.0, part.swapped);
        add(total.plain, 1.0, part.plain);
        total.area += part.area, total.gaussian += part.gaussian;
        total.edge_mass += part.edge_mass, total.vertex_mass += part.vertex_mass;
        undecided += block.undecided;
        faces.insert(faces.end(), block.faces.begin(), block.faces.end());
    }
    return total;
}

}  // namespace curvature

RegionResult compute_region_measures(const TriangleMesh& mesh, const Region& region, const RegionOptions& options,
                                     const RunControl& control) {
    using namespace curvature;
    require_valid(options);
    RegionResult result;
    const Surface surface = build_surface(mesh, control);
    const Cells cells = build_cells(surface, control);
    const CompiledRegion compiled(region, surface);
    const double tolerance = options.tolerance.relative_to_diagonal
                                 ? options.tolerance.value * surface.diagonal
                                 : std::ldexp(options.tolerance.value, -surface.exponent);
    double undecided = 0.0;
    std::vector<Index> faces;
    const Sums sums = measure_region(surface, cells, compiled, options.rim, tolerance, undecided, faces, control);
    result.measures = measures_of(sums, surface.exponent);
    result.undecided_area = std::ldexp(undecided, 2 * surface.exponent);
    result.statistics = surface.statistics;
    result.statistics.mean_edge_length = std::ldexp(surface.statistics.mean_edge_length, surface.exponent);
    if (control.cancelled()) {
        result.outcome = Outcome::cancelled;
        return result;
    }
    if (options.bounds && !faces.empty()) {
        Marks inside(surface.faces.size());
        inside.clear();
        for (const Index f : faces) inside.mark(f);
        const double kappa = options.max_curvature ? std::ldexp(*options.max_curvature, surface.exponent)
                                                   : estimate_curvature(surface, cells, faces);
        const std::vector<TriangleShape> shapes = build_shapes(surface, control);
        BoundSum sum(surface, cells, shapes, kappa);
        sum.add_region(faces, [&](Index f) { return inside.has(f); });
        result.bound = sum.result(!options.max_curvature);
    }
    return result;
}

std::vector<int> compute_multiplicities(const TriangleMesh& mesh, VertexId vertex,
                                        const std::vector<Point3>& directions) {
    using namespace curvature;
    const auto refuse = [&](DefectKind kind, const std::string& message) {
        throw InputError({{kind, {{ElementKind::vertex, index_of(vertex)}}, {}, message}});
    };
    const std::string name = "vertex " + std::to_string(index_of(vertex) + std::uint64_t{1});
    if (index_of(vertex) >= mesh.positions.size())
        refuse(DefectKind::index_out_of_range, name + " of " + std::to_string(mesh.positions.size()));
    // The star of the vertex is all that matters.
    TriangleMesh star;
    star.positions = mesh.positions;
    for (const Triangle& t : mesh.triangles)
        if (std::find(t.begin(), t.end(), vertex) != t.end()) star.triangles.push_back(t);
    const Surface surface = build_surface(star, {});
    const Index v = surface.sorted_vertices[index_of(vertex)];
    if (!has_solid_link(surface, v))
        refuse(DefectKind::open_facet,
               "the triangles around " + name + " are not closed up, or not consistently oriented: it bounds no solid");
    std::vector<int> multiplicities;
    multiplicities.reserve(directions.size());
    for (const Point3& h : directions) multiplicities.push_back(1 - upper_link_characteristic(surface, v, h));
    return multiplicities;
}

Region make_ball_region(const Point3& center, double radius) {
    Region region;
    region.kind = Region::Kind::ball, region.center = center, region.radius = radius;
    return region;
}

Region make_box_region(const Point3& lower, const Point3& upper) {
    Region region;
    region.kind = Region::Kind::box, region.center = lower, region.corner = upper;
    return region;
}

Region make_half_space_region(const Point3& point, const Point3& outward_normal) {
    Region region;
    region.kind = Region::Kind::half_space, region.center = point, region.corner = outward_normal;
    return region;
}

Region make_face_region(std::vector<std::uint32_t> faces) {
    Region region;
    region.kind = Region::Kind::faces, region.faces = std::move(faces);
    return region;
}

Region make_complement(Region inner) {
    Region region;
    region.kind = Region::Kind::complement;
    region.parts.push_back(std::move(inner));
    return region;
}

Region make_intersection(std::vector<Region> regions) {
    Region region;
    region.kind = Region::Kind::both, region.parts = std::move(regions);
    return region;
}

Region make_union(std::vector<Region> regions) {
    Region region;
    region.kind = Region::Kind::either, region.parts = std::move(regions);
    return region;
}

}  // namespace certa
