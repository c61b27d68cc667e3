// Gauss-Seidel: one Newton step per vertex and round, on differences.
//
// Linear interpolation of a quadratic form Q over a triangle errs by squares whose integral is area / 360 times
// (sum of q_i^2 + sum of q_i q_j), where q_i = Q(side i). Q has the directions of the field and the inverse squares of
// the spacing as eigenvalues: a cell of lines as far apart as they may be has sides with q = 1. Quads count as cut
// along either diagonal, half each.
#include "remeshing/even_out.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>

#include "core/vector3.h"

namespace certa::remeshing {
namespace {

constexpr double never = std::numeric_limits<double>::infinity();
constexpr std::size_t samples = 6;  // of the input per triangle

struct Form {
    std::array<double, 6> q{};  // symmetric: xx xy xz yy yz zz
    Point3 normal;

    double operator()(const Point3& e) const {
        return e.x * (q[0] * e.x + 2.0 * (q[1] * e.y + q[2] * e.z)) + e.y * (q[3] * e.y + 2.0 * q[4] * e.z) +
               q[5] * e.z * e.z;
    }
    void add(double s, const Point3& d) {
        q[0] += s * d.x * d.x, q[1] += s * d.x * d.y, q[2] += s * d.x * d.z;
        q[3] += s * d.y * d.y, q[4] += s * d.y * d.z, q[5] += s * d.z * d.z;
    }
};

Point3 unit(const Point3& v) {
    const double length = norm(v);
    return length > 0.0 ? (1.0 / length) * v : Point3{};
}

struct Curve {
    std::vector<Point3> points;
    std::vector<Triangle> segments;  // (a, b, b)
    std::unique_ptr<core::TriangleTree> tree;
};

class Evening {
public:
    Evening(const WorkMesh& surface, const DirectionField& field, const Spacing& spacing,
            const core::TriangleTree& tree, CoarseMesh& mesh, const RunControl& control)
        : surface_(surface), field_(field), spacing_(spacing), tree_(tree), mesh_(mesh), control_(control) {
        around_.resize(mesh.points.size());
        for (Index q = 0; q < mesh.polygon_count(); ++q)
            for (const Index v : mesh.polygon(q)) around_[v].push_back(q);
        std::vector<std::array<Index, 2>> sides;
        for (Index q = 0; q < mesh.polygon_count(); ++q) {
            const auto ring = mesh.polygon(q);
            for (std::size_t i = 0; i < ring.size(); ++i) sides.push_back({ring[i], ring[(i + 1) % ring.size()]});
        }
        std::sort(sides.begin(), sides.end());
        is_on_rim_.assign(mesh.points.size(), 0);
        for (const auto& [a, b] : sides)
            if (!std::binary_search(sides.begin(), sides.end(), std::array{b, a})) is_on_rim_[a] = is_on_rim_[b] = 1;
        forms_.resize(mesh.polygon_count());
        hints_.assign(mesh.polygon_count(), no_index);
        curves_.resize(surface.curves.size());
        sides_.resize(mesh.points.size());
        for (Index e = 0; e < mesh.feature_edges.size(); ++e)
            for (const Index v : {mesh.feature_edges[e].a, mesh.feature_edges[e].b}) sides_[v].push_back(e);
    }

    void run() {
        constexpr int rounds = 20;
        if (mesh_.polygon_count() == 0) return;
        const std::vector<Point3> points = mesh_.points;
        const std::vector<SurfacePlace> places = mesh_.places;
        const std::vector<Gap> before = find_gaps();
        for (int round = 0; round < rounds && !control_.cancelled(); ++round) {
            for (Index q = 0; q < forms_.size(); ++q) find_form(q);
            for (Index v = 0; v < mesh_.points.size(); ++v) move(v);
        }
        take_back(before, points, places);
    }

private:
    /// How far a vertex of the input is from the mesh, and from which of its polygons.
    struct Gap {
        double distance = 0.0;
        Index polygon = no_index;
    };
    /// Of vertices of the input, a few per triangle of the mesh: always the same ones.
    std::vector<Gap> find_gaps() const {
        std::vector<Index> polygons;
        std::vector<Triangle> triangles;
        for (Index q = 0; q < mesh_.polygon_count(); ++q) {
            const auto ring = mesh_.polygon(q);
            for (std::size_t i = 1; i + 1 < ring.size(); ++i) {
                triangles.push_back({VertexId{ring[0]}, VertexId{ring[i]}, VertexId{ring[i + 1]}});
                polygons.push_back(q);
            }
        }
        const core::TriangleTree mesh(mesh_.points, triangles);
        const std::size_t step = std::max<std::size_t>(1, surface_.points.size() / (samples * triangles.size() + 1));
        std::vector<Gap> gaps;
        for (std::size_t i = 0; i < surface_.points.size(); i += step) {
            const core::NearestPoint at = mesh.find_nearest(surface_.points[i]);
            gaps.push_back({std::sqrt(at.squared_distance), polygons[at.triangle]});
        }
        return gaps;
    }
    /// Thin parts may slip out between vertices that slide: where gaps have opened, these go back.
    void take_back(const std::vector<Gap>& before, const std::vector<Point3>& points,
                   const std::vector<SurfacePlace>& places) {
        constexpr double wider = 2.0, wide = 3.0;  // than before; than the root mean square
        double sum = 0.0;
        for (const Gap& gap : before) sum += gap.distance * gap.distance;
        const double enough = wide * std::sqrt(sum / double(before.size()));
        for (bool is_wider = true; is_wider && !control_.cancelled();) {
            is_wider = false;
            const auto back = [&](Index q) {
                for (const Index v : mesh_.polygon(q)) {
                    is_wider = is_wider || mesh_.points[v] != points[v];
                    mesh_.points[v] = points[v], mesh_.places[v] = places[v];
                }
            };
            const std::vector<Gap> after = find_gaps();
            for (std::size_t i = 0; i < after.size(); ++i)
                if (after[i].distance > std::max(enough, wider * before[i].distance))
                    back(before[i].polygon), back(after[i].polygon);
        }
    }

    void find_form(Index q) {
        Point3 sum;
        for (const Index v : mesh_.polygon(q)) sum = sum + mesh_.points[v];
        const core::NearestPoint at = tree_.find_nearest((1.0 / double(mesh_.polygon(q).size())) * sum, hints_[q]);
        hints_[q] = at.triangle;
        const Index f = at.triangle;
        const auto& c = surface_.faces[f];
        const Point3 &a = surface_.points[c[0]], &b = surface_.points[c[1]], &d = surface_.points[c[2]];
        const Point3 x = unit(b - a), normal = unit(cross(b - a, d - a)), y = cross(normal, x);
        const std::array<Complex, 3> squares = corner_values(surface_, field_, f);
        Complex square{};
        std::array<double, 2> inverse{};
        for (Index i = 0; i < 3; ++i) {
            const Index w = surface_.wedges[3 * f + i];
            square += at.weights[i] * squares[i];
            for (std::size_t k = 0; k < 2; ++k) inverse[k] += at.weights[i] / (spacing_.at[k][w] * spacing_.at[k][w]);
        }
        const double angle = 0.5 * std::arg(square);
        const Point3 along = std::cos(angle) * x + std::sin(angle) * y;  // of k_max
        Form form;
        form.normal = normal;
        // Lines along the direction of k_max lie at[along_max] apart: measured along that of k_min.
        form.add(inverse[along_min], along);
        form.add(inverse[along_max], cross(normal, along));
        forms_[q] = form;
    }

    double cost(const Form& form, const Point3& a, const Point3& b, const Point3& c) const {
        const double area = dot(cross(b - a, c - a), form.normal);
        if (!(area > 0.0)) return never;
        const double u = form(b - a), v = form(c - b), w = form(a - c);
        return area * (u * u + v * v + w * w + u * v + v * w + w * u);
    }
    double cost_of(Index q) const {
        const auto ring = mesh_.polygon(q);
        const auto at = [&](std::size_t i) -> const Point3& { return mesh_.points[ring[i]]; };
        if (ring.size() == 3) return cost(forms_[q], at(0), at(1), at(2));
        if (ring.size() == 4)
            return 0.5 * (cost(forms_[q], at(0), at(1), at(2)) + cost(forms_[q], at(0), at(2), at(3)) +
                          cost(forms_[q], at(0), at(1), at(3)) + cost(forms_[q], at(1), at(2), at(3)));
        return 0.0;
    }
    double cost_around(Index v) const {
        double sum = 0.0;
        for (const Index q : around_[v]) sum += cost_of(q);
        return sum;
    }

    const core::TriangleTree* curve_of(Index v) {
        const Index c = mesh_.curves[v];
        if (c >= curves_.size()) return nullptr;
        Curve& curve = curves_[c];
        if (!curve.tree) {
            for (const Index e : surface_.curves[c].edges) {
                const Index h = surface_.edge_halfedges[e];
                const auto first = static_cast<std::uint32_t>(curve.points.size());
                curve.points.push_back(surface_.points[surface_.start_of(h)]);
                curve.points.push_back(surface_.points[surface_.end_of(h)]);
                curve.segments.push_back({VertexId{first}, VertexId{first + 1}, VertexId{first + 1}});
            }
            curve.tree = std::make_unique<core::TriangleTree>(curve.points, curve.segments);
        }
        return curve.tree.get();
    }

    void move(Index v) {
        const Point3 start = mesh_.points[v];
        const VertexKind kind = mesh_.kinds[v];
        if (kind == VertexKind::corner || around_[v].empty()) return;
        if (kind == VertexKind::smooth && is_on_rim_[v] != 0) return;
        const core::TriangleTree* curve = kind == VertexKind::smooth ? nullptr : curve_of(v);
        if (kind != VertexKind::smooth && curve == nullptr) return;
        const double before = cost_around(v);
        if (!(before < never)) return;
        double shortest = never;
        for (const Index q : around_[v])
            for (const Index w : mesh_.polygon(q))
                if (w != v) shortest = std::min(shortest, distance(start, mesh_.points[w]));
        Point3 x, y;
        if (curve != nullptr) {
            const Index s = curve->find_nearest(start).triangle;
            const auto& points = curves_[mesh_.curves[v]].points;
            x = unit(points[2 * s + 1] - points[2 * s]);
        } else {
            Point3 normal;
            for (const Index q : around_[v]) normal = normal + forms_[q].normal;
            normal = unit(normal);
            const Point3 some = std::abs(normal.x) < 0.6 ? Point3{1, 0, 0} : Point3{0, 1, 0};
            x = unit(cross(normal, some));
            y = cross(normal, x);
        }
        const double sagitta = curve != nullptr ? sagitta_at(v, *curve) : 0.0;
        const double h = 0.02 * shortest;
        const auto at = [&](double i, double j) {
            mesh_.points[v] = start + (h * i) * x + (h * j) * y;
            const double c = cost_around(v);
            mesh_.points[v] = start;
            return c;
        };
        const double e = at(1, 0), w = at(-1, 0);
        if (!(e < never && w < never)) return;
        double gx = 0.5 * (e - w), gy = 0.0, xx = e - 2.0 * before + w, yy = 1.0, xy = 0.0;
        if (curve == nullptr) {
            const double n = at(0, 1), s = at(0, -1), ne = at(1, 1), sw = at(-1, -1);
            if (!(n < never && s < never && ne < never && sw < never)) return;
            gy = 0.5 * (n - s);
            yy = n - 2.0 * before + s;
            xy = 0.5 * (ne + sw - 2.0 * before - xx - yy);
        }
        const double det = xx * yy - xy * xy;
        if (!(xx > 0.0 && det > 0.0)) return;
        double i = (xy * gy - yy * gx) / det, j = (xy * gx - xx * gy) / det;
        const double length = h * std::hypot(i, j);
        if (length > 0.25 * shortest) i *= 0.25 * shortest / length, j *= 0.25 * shortest / length;
        for (int half = 0; half < 3; ++half, i *= 0.5, j *= 0.5) {
            const Point3 there = start + (h * i) * x + (h * j) * y;
            const core::NearestPoint on =
                curve != nullptr ? curve->find_nearest(there) : tree_.find_nearest(there, mesh_.places[v].face);
            mesh_.points[v] = on.point;
            if (cost_around(v) < before && (curve == nullptr || sagitta_at(v, *curve) <= sagitta)) {
                mesh_.places[v] = curve != nullptr ? place_of(on.point) : SurfacePlace{on.triangle, on.weights};
                return;
            }
        }
        mesh_.points[v] = start;
    }
    /// How far the middles of the two sides along the curve are from it.
    double sagitta_at(Index v, const core::TriangleTree& curve) const {
        double most = 0.0;
        for (const Index e : sides_[v]) {
            const FeatureEdge& side = mesh_.feature_edges[e];
            const Point3 middle = 0.5 * (mesh_.points[side.a] + mesh_.points[side.b]);
            most = std::max(most, curve.find_nearest(middle).squared_distance);
        }
        return most;
    }
    SurfacePlace place_of(const Point3& p) const {
        const core::NearestPoint on = tree_.find_nearest(p);
        return {on.triangle, on.weights};
    }

    const WorkMesh& surface_;
    const DirectionField& field_;
    const Spacing& spacing_;
    const core::TriangleTree& tree_;
    CoarseMesh& mesh_;
    const RunControl& control_;
    std::vector<std::uint8_t> is_on_rim_;             ///< per vertex: beside a side of one polygon only
    std::vector<std::vector<Index>> around_, sides_;  ///< per vertex: polygons; feature edges
    std::vector<Form> forms_;
    std::vector<Index> hints_;
    std::vector<Curve> curves_;
};

}  // namespace

void even_out(const WorkMesh& surface, const DirectionField& field, const Spacing& spacing,
              const core::TriangleTree& tree, CoarseMesh& mesh, const RunControl& control) {
    Evening(surface, field, spacing, tree, mesh, control).run();
}

}  // namespace certa::remeshing
