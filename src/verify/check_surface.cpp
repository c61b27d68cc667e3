// What `remesh` promises, decided on any mesh: shape, folds, contacts, creases, distance.
//
// Folds: the nearest polygons of the input to the middle of a triangle, all that are as near as the nearest, must not
// all turn away from it. Contacts: candidates from a tree of boxes, decided by exact signs. Creases: points along them,
// about 30,000 in all and at least three on each edge, against a tree of the mesh's edges.
#include <certa/surface_check.h>

#include <algorithm>
#include <cmath>

#include "core/parallel.h"
#include "core/vector3.h"
#include "verify/polygon_surface.h"
#include "verify/report.h"
#include "verify/surface_contacts.h"
#include "verify/surface_shape.h"

namespace certa {
namespace {

using core::TriangleTree;
using verify::PolygonSurface;
using verify::show;

ElementRef polygon_ref(std::uint32_t q) { return {ElementKind::polygon, q}; }

struct Contact {
    std::uint32_t first = 0, second = 0;  // polygons
    bool is_chosen = false;               // of the triangles that are measured
    Point3 place;
};

/// Pairs of polygons that meet beyond shared corners, each once.
std::vector<Contact> list_contacts(const PolygonSurface& surface, const RunControl& control) {
    struct Entry {
        PolygonSurface::Corners corners;
        std::uint32_t polygon = 0;
        bool is_chosen = false;
    };
    std::vector<Entry> entries;
    std::vector<verify::BoundingBox> boxes;
    std::size_t next_chosen = 0;
    for (std::uint32_t q = 0; q < surface.polygon_count(); ++q) {
        std::vector<PolygonSurface::Corners> chosen;
        for (; next_chosen < surface.triangles().size() && surface.polygon_of(next_chosen) == q; ++next_chosen) {
            const Triangle& t = surface.triangles()[next_chosen];
            chosen.push_back({index_of(t[0]), index_of(t[1]), index_of(t[2])});
        }
        for (const PolygonSurface::Corners& corners : surface.possible(q)) {
            const verify::Corners points = surface.points(corners);
            if (verify::is_degenerate(points)) continue;
            entries.push_back({corners, q, std::find(chosen.begin(), chosen.end(), corners) != chosen.end()});
            boxes.push_back(verify::BoundingBox::of(points));
        }
    }
    const auto do_meet = [&](const Entry& s, const Entry& t) {
        return verify::meet_beyond_shared(surface.positions(), s.corners, t.corners);
    };
    const verify::BoxTree tree(boxes);
    constexpr std::size_t block = 1024;
    std::vector<std::vector<Contact>> found((entries.size() + block - 1) / block);
    core::parallel_for(found.size(), 1, control, [&](std::size_t begin, std::size_t end) {
        for (std::size_t b = begin; b < end && !control.cancelled(); ++b)
            for (std::size_t i = b * block; i < std::min(entries.size(), (b + 1) * block); ++i)
                tree.visit(boxes[i], [&](std::uint32_t j) {
                    const Entry &s = entries[i], &t = entries[j];
                    if (j <= i || s.polygon == t.polygon || !do_meet(s, t)) return true;
                    found[b].push_back(
                        {s.polygon, t.polygon, s.is_chosen && t.is_chosen, surface.points(s.corners)[0]});
                    return true;
                });
    });
    std::vector<Contact> all;
    for (const auto& part : found) all.insert(all.end(), part.begin(), part.end());
    std::stable_sort(all.begin(), all.end(), [](const Contact& l, const Contact& r) {
        if (l.first != r.first) return l.first < r.first;
        if (l.second != r.second) return l.second < r.second;
        return l.is_chosen && !r.is_chosen;
    });
    all.erase(
        std::unique(all.begin(), all.end(),
                    [](const Contact& l, const Contact& r) { return l.first == r.first && l.second == r.second; }),
        all.end());
    return all;
}

std::string text_of(const std::vector<ComponentShape>& parts) {
    std::string text = parts.size() == 1 ? "1 component" : std::to_string(parts.size()) + " components";
    constexpr std::size_t most = 8;
    for (std::size_t i = 0; i < std::min(most, parts.size()); ++i)
        text += std::string(i == 0 ? " (" : "; ") + "genus " + std::to_string(parts[i].genus) + ", " +
                std::to_string(parts[i].boundary_loops) + (parts[i].boundary_loops == 1 ? " loop" : " loops");
    return text + (parts.size() > most ? "; ...)" : parts.empty() ? "" : ")");
}

class Checker {
public:
    Checker(const PolygonMesh& mesh, const PolygonMesh& input, const SurfaceCheckOptions& options,
            const RunControl& control)
        : mesh_(mesh), input_(input), options_(options), control_(control) {}

    SurfaceCheck run() {
        if (options_.error) check_.promises = {"error"};
        measure();
        check_shape();
        const int exponent = verify::find_exponent(mesh_, input_);
        surface_.emplace(mesh_, exponent);
        base_.emplace(input_, exponent);
        tree_.emplace(base_->positions(), base_->triangles());
        surface_->choose(*tree_, control_);
        control_.report("folds", 0.0);
        check_folds();
        control_.report("contacts", 0.0);
        check_contacts();
        control_.report("creases", 0.0);
        check_creases();
        check_error();
        if (control_.cancelled()) {
            check_.outcome = Outcome::cancelled;
            violate("well-formed", {}, {}, "the check was cancelled: nothing is decided");
        }
        return std::move(check_);
    }

private:
    void violate(const char* promise, std::vector<ElementRef> elements, const Point3& place, std::string message) {
        ++check_.violation_count;
        constexpr std::ptrdiff_t most = 100;
        const auto same = std::count_if(check_.violations.begin(), check_.violations.end(),
                                        [&](const Violation& v) { return v.promise == promise; });
        if (same < most) check_.violations.push_back({promise, std::move(elements), place, std::move(message)});
    }

    void check_shape() {
        check_.mesh = compute_surface_shape(mesh_);
        check_.input = compute_surface_shape(input_);
        const SurfaceShape &a = check_.mesh, &b = check_.input;
        if (b.is_oriented()) {
            check_.promises.push_back("well-formed");
            find_bad_edges();
            if (a.non_manifold_vertices > 0)
                violate("well-formed", {}, {},
                        std::to_string(a.non_manifold_vertices) +
                            " vertices are not manifold: their polygons form more than one fan");
        }
        if (!b.is_manifold()) return;
        check_.promises.push_back("topology");
        if (a.components != b.components)
            violate("topology", {}, {},
                    "the mesh has " + text_of(a.components) + ", the input " + text_of(b.components));
    }
    void find_bad_edges() {
        const std::vector<verify::PolygonSide> sides = verify::sort_sides(mesh_);
        for (std::size_t i = 0; i < sides.size();) {
            const std::size_t end = verify::end_of_edge(sides, i);
            const bool is_crowded = end - i > 2,
                       is_inconsistent = end - i == 2 && sides[i].is_reversed == sides[i + 1].is_reversed;
            if (is_crowded || is_inconsistent)
                violate("well-formed", {polygon_ref(sides[i].polygon), polygon_ref(sides[i + 1].polygon)},
                        mesh_.positions[sides[i].low],
                        "the edge between " + verify::show_vertices({sides[i].low, sides[i].high}) +
                            (is_crowded ? " belongs to " + std::to_string(end - i) + " polygons"
                                        : " is walked the same way by both its polygons"));
            i = end;
        }
    }

    /// Whether a triangle at x with this normal turns away from all that is nearest below.
    bool is_turned_away(const Point3& x, const Point3& normal) const {
        const core::NearestPoint nearest = tree_->find_nearest(x);
        const double reach = std::sqrt(nearest.squared_distance) * (1.0 + 1e-9) + 1e-12;
        const Point3 size{reach, reach, reach};
        bool is_away = true;
        tree_->visit_box(x - size, x + size, [&](std::uint32_t t) {
            const auto p = base_->points_of_triangle(t);
            if (core::find_nearest_on_triangle(x, p[0], p[1], p[2]).squared_distance > reach * reach) return;
            if (dot(cross(p[1] - p[0], p[2] - p[0]), normal) > 0.0) is_away = false;
        });
        return is_away;
    }
    void check_folds() {
        if (!check_.input.is_oriented()) return;
        check_.promises.push_back("unfolded");
        std::vector<std::uint8_t> is_folded(surface_->triangles().size(), 0);
        core::parallel_for(is_folded.size(), 256, control_, [&](std::size_t begin, std::size_t end) {
            for (std::size_t t = begin; t < end && !control_.cancelled(); ++t) {
                const auto p = surface_->points_of_triangle(t);
                const Point3 normal = cross(p[1] - p[0], p[2] - p[0]);
                const double longest = std::max(
                    {dot(p[1] - p[0], p[1] - p[0]), dot(p[2] - p[1], p[2] - p[1]), dot(p[0] - p[2], p[0] - p[2])});
                if (norm(normal) <= 1e-9 * longest) continue;  // a needle has no side
                is_folded[t] = is_turned_away((1.0 / 3.0) * (p[0] + p[1] + p[2]), normal);
            }
        });
        std::uint32_t last = no_index;
        for (std::size_t t = 0; t < is_folded.size(); ++t) {
            const std::uint32_t q = surface_->polygon_of(t);
            if (is_folded[t] == 0 || q == last) continue;
            last = q;
            ++check_.folded_polygons;
            violate("unfolded", {polygon_ref(q)}, mesh_.positions[index_of(surface_->triangles()[t][0])],
                    show("polygon", q) + " turns away from the input below it by 90 degrees or more");
        }
    }

    void check_contacts() {
        const std::vector<Contact> contacts = list_contacts(*surface_, control_);
        check_.possible_contacts = contacts.size();
        for (const Contact& contact : contacts) check_.contacts += contact.is_chosen;
        if (check_.contacts > 0)
            for (const Contact& contact : list_contacts(*base_, control_)) check_.input_contacts += contact.is_chosen;
        if (check_.input_contacts > 0) return;
        check_.promises.push_back("embedded");
        for (const Contact& contact : contacts)
            if (contact.is_chosen)
                violate("embedded", {polygon_ref(contact.first), polygon_ref(contact.second)},
                        mesh_.positions[index_of(mesh_.corners[mesh_.offsets[contact.first]])],
                        show("polygon", contact.first) + " and " + show("polygon", contact.second) +
                            " meet beyond what they share");
    }

    TriangleTree tree_of_edges() const {
        std::vector<Triangle> edges;
        const std::vector<verify::PolygonSide> sides = verify::sort_sides(mesh_);
        for (std::size_t i = 0; i < sides.size(); i = verify::end_of_edge(sides, i))
            edges.push_back({VertexId{sides[i].low}, VertexId{sides[i].high}, VertexId{sides[i].high}});
        return {surface_->positions(), edges};
    }
    TriangleTree tree_of_vertices() const {
        std::vector<bool> is_used(mesh_.positions.size(), false);
        for (const VertexId v : mesh_.corners) is_used[index_of(v)] = true;
        std::vector<Triangle> points;
        for (std::uint32_t v = 0; v < is_used.size(); ++v)
            if (is_used[v]) points.push_back({VertexId{v}, VertexId{v}, VertexId{v}});
        return {surface_->positions(), points};
    }

    void check_creases() {
        const verify::Creases creases = verify::find_creases(input_, options_);
        CreaseCover& cover = check_.creases;
        cover.edges = creases.edges.size(), cover.corners = creases.corners.size();
        if (creases.edges.empty()) return;
        check_.promises.push_back("creases");
        const std::vector<Point3>& points = base_->positions();
        double length = 0.0;
        for (const auto& [a, b] : creases.edges) length += distance(points[a], points[b]);
        const TriangleTree edges = tree_of_edges(), vertices = tree_of_vertices();
        double sum = 0.0, worst_square = -1.0;
        std::uint32_t hint = no_index;
        for (const auto& [a, b] : creases.edges) {
            const double part = distance(points[a], points[b]);
            const int steps = 2 + static_cast<int>(30000.0 * part / std::max(length, 1e-300));
            for (int i = 0; i <= steps; ++i) {
                const double s = static_cast<double>(i) / steps;
                const core::NearestPoint nearest = edges.find_nearest((1.0 - s) * points[a] + s * points[b], hint);
                hint = nearest.triangle;
                sum += part / steps * (i == 0 || i == steps ? 0.5 : 1.0) * std::sqrt(nearest.squared_distance);
                if (nearest.squared_distance <= worst_square) continue;
                worst_square = nearest.squared_distance;
                cover.largest_place = (1.0 - s) * input_.positions[a] + s * input_.positions[b];
            }
        }
        Point3 corner_place;
        double corner_square = -1.0;
        for (const std::uint32_t v : creases.corners) {
            const double square = vertices.find_nearest(points[v]).squared_distance;
            if (square > corner_square) corner_square = square, corner_place = input_.positions[v];
        }
        const double unit = std::ldexp(1.0, verify::find_exponent(mesh_, input_));
        cover.length = unit * length;
        cover.mean_distance = length > 0.0 ? unit * sum / length : 0.0;
        cover.largest_distance = unit * std::sqrt(std::max(0.0, worst_square));
        cover.corner_distance = unit * std::sqrt(std::max(0.0, corner_square));
        demand_cover(corner_place);
    }
    void demand_cover(const Point3& corner_place) {
        const CreaseCover& cover = check_.creases;
        const double diagonal = check_.distance.diagonal;
        const double found = std::max(check_.distance.hausdorff_bound, check_.distance.hausdorff);
        double tolerance = std::max(1e-6 * diagonal, options_.error ? options_.error->resolve(diagonal) : found);
        if (options_.crease_tolerance) tolerance = options_.crease_tolerance->resolve(diagonal);
        if (cover.largest_distance > tolerance)
            violate("creases", {}, cover.largest_place,
                    "a crease of the input is " + show(cover.largest_distance) +
                        " from the nearest edge of the mesh at " + show(cover.largest_place) + "; allowed are " +
                        show(tolerance));
        if (cover.corner_distance > tolerance)
            violate("creases", {}, corner_place,
                    "the corner of the input at " + show(corner_place) + " is " + show(cover.corner_distance) +
                        " from the nearest vertex of the mesh; allowed are " + show(tolerance));
    }

    /// Once more where the bound proves too little only because nobody looked closely enough.
    void measure() {
        check_.distance = measure_distance(mesh_, input_, options_.distance, control_);
        if (!options_.error || control_.cancelled()) return;
        const double allowed = options_.error->resolve(check_.distance.diagonal);
        if (check_.distance.hausdorff_bound <= allowed || check_.distance.hausdorff > allowed) return;
        DistanceOptions closer = options_.distance;
        closer.resolution = {0.25 * allowed, false};
        check_.distance = measure_distance(mesh_, input_, closer, control_);
    }

    void check_error() {
        if (!options_.error) return;
        const double allowed = options_.error->resolve(check_.distance.diagonal);
        const auto demand = [&](const OneSidedDistance& side, const char* direction) {
            if (side.bound <= allowed) return;
            const bool is_proved_above = side.largest > allowed;
            violate("error", {}, side.largest_place,
                    std::string("the distance from ") + direction + " is " +
                        (is_proved_above ? show(side.largest) + " at " + show(side.largest_place)
                                         : "at most " + show(side.bound) + ", which proves too little") +
                        "; allowed are " + show(allowed));
        };
        demand(check_.distance.to_second, "the mesh to the input");
        demand(check_.distance.to_first, "the input to the mesh");
    }

    const PolygonMesh &mesh_, &input_;
    const SurfaceCheckOptions& options_;
    const RunControl& control_;
    SurfaceCheck check_;
    std::optional<PolygonSurface> surface_, base_;
    std::optional<TriangleTree> tree_;
};

void check_options(const SurfaceCheckOptions& options, const PolygonMesh& input) {
    std::vector<Defect> defects;
    const auto demand = [&](bool is_fine, const char* message) {
        if (!is_fine) defects.push_back({DefectKind::option_out_of_range, {{ElementKind::option, 0}}, {}, message});
    };
    demand(!options.error || options.error->value > 0.0, "error must be above 0");
    demand(!options.error || options.distance.bound, "error can only be checked with the bound");
    demand(options.feature_angle_radians > 0.0 && options.feature_angle_radians <= 3.1415926535897936,
           "feature_angle must be above 0 and at most 180 degrees");
    demand(!options.crease_tolerance || options.crease_tolerance->value >= 0.0, "crease_tolerance must not be below 0");
    for (const Edge& edge : options.features)
        demand(index_of(edge[0]) < input.positions.size() && index_of(edge[1]) < input.positions.size(),
               "features must be pairs of vertices of the input");
    if (!defects.empty()) throw InputError(std::move(defects));
}

}  // namespace

SurfaceCheck check_surface(const PolygonMesh& mesh, const PolygonMesh& input, const SurfaceCheckOptions& options,
                           const RunControl& control) {
    check_options(options, input);
    return Checker(mesh, input, options, control).run();
}

std::vector<std::array<std::uint32_t, 2>> find_contacts(const PolygonMesh& mesh, const RunControl& control) {
    std::vector<Defect> defects;
    verify::find_polygon_defects(mesh, "the surface", defects);
    if (!defects.empty()) throw InputError(std::move(defects));
    const PolygonSurface surface(mesh, verify::find_exponent(mesh, mesh));
    std::vector<std::array<std::uint32_t, 2>> pairs;
    for (const Contact& contact : list_contacts(surface, control))
        pairs.push_back({std::min(contact.first, contact.second), std::max(contact.first, contact.second)});
    std::sort(pairs.begin(), pairs.end());
    pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
    return pairs;
}

}  // namespace certa
