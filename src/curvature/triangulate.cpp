// Surfaces of triangles from polygons and from tetrahedra; results as fields of a document.
//
// A polygon is cut by clipping ears in the plane of its Newell normal, best-shaped ear first, ties by the vertex's
// number: the cut depends on the polygon only, not on where its list starts. Where no ear can be found (polygons that
// cross themselves) what is left is fanned. The boundary of tetrahedra is every face that one of the chosen ones has
// and no other chosen one.
#include <algorithm>
#include <map>
#include <set>

#include "core/vector3.h"
#include "curvature/surface.h"

namespace certa {
namespace {

using curvature::Index;

class EarClipper {
public:
    EarClipper(const std::vector<Point3>& positions, std::vector<VertexId> ring)
        : positions_(positions), ring_(std::move(ring)) {
        std::rotate(ring_.begin(), std::min_element(ring_.begin(), ring_.end()), ring_.end());
        for (std::size_t i = 0; i < ring_.size(); ++i) normal_ = normal_ + cross(at(i) - at(0), at(i + 1) - at(0));
    }

    template <class Emit>
    void run(const Emit& emit) {
        while (ring_.size() > 3) {
            const std::size_t ear = find_ear();
            const std::size_t n = ring_.size();
            emit(Triangle{ring_[(ear + n - 1) % n], ring_[ear], ring_[(ear + 1) % n]});
            ring_.erase(ring_.begin() + static_cast<std::ptrdiff_t>(ear));
        }
        emit(Triangle{ring_[0], ring_[1], ring_[2]});
    }

private:
    const Point3& at(std::size_t i) const { return positions_[index_of(ring_[i % ring_.size()])]; }
    double side(const Point3& a, const Point3& b, const Point3& c) const { return dot(normal_, cross(b - a, c - a)); }

    /// The convex corner with no other vertex in its triangle, best shape first; the first convex corner if none is
    /// empty; 1 if none is convex.
    std::size_t find_ear() const {
        const std::size_t n = ring_.size();
        std::size_t best = 1;
        double best_shape = -1.0;
        for (std::size_t i = 0; i < n; ++i) {
            const Point3 &a = at(i + n - 1), &b = at(i), &c = at(i + 1);
            const double area = side(a, b, c);
            if (!(area > 0.0)) continue;
            const double lengths = dot(b - a, b - a) + dot(c - b, c - b) + dot(a - c, a - c);
            const double shape = area / lengths;
            if (!(shape > best_shape)) continue;
            bool empty = true;
            for (std::size_t j = i + 2; j < i + n - 1 && empty; ++j) {
                const Point3& p = at(j);
                empty = !(side(a, b, p) >= 0.0 && side(b, c, p) >= 0.0 && side(c, a, p) >= 0.0) || p == a || p == c;
            }
            if (empty) best = i, best_shape = shape;
        }
        return best;
    }

    const std::vector<Point3>& positions_;
    std::vector<VertexId> ring_;
    Point3 normal_;
};

void require_corners(const std::vector<VertexId>& ring, std::size_t points, Index polygon) {
    for (const VertexId v : ring)
        if (index_of(v) >= points)
            throw InputError({{DefectKind::index_out_of_range,
                               {{ElementKind::polygon, polygon}},
                               {},
                               "polygon " + std::to_string(polygon + std::uint64_t{1}) + " names vertex " +
                                   std::to_string(index_of(v) + std::uint64_t{1}) + " of " + std::to_string(points)}});
}

template <class Offsets>
void add_polygons(TriangulatedSurface& surface, const std::vector<VertexId>& corners, const Offsets& offsets) {
    for (std::size_t p = 0; p + 1 < offsets.size(); ++p) {
        std::vector<VertexId> ring(corners.begin() + offsets[p], corners.begin() + offsets[p + 1]);
        const auto polygon = static_cast<Index>(p);
        if (ring.size() < 3) continue;
        require_corners(ring, surface.mesh.positions.size(), polygon);
        const auto emit = [&](const Triangle& t) {
            surface.mesh.triangles.push_back(t);
            surface.source_faces.push_back(polygon);
        };
        if (ring.size() == 3)
            emit({ring[0], ring[1], ring[2]});
        else
            EarClipper(surface.mesh.positions, std::move(ring)).run(emit);
    }
}

/// The region of each tetrahedron: field "region", else "marker"; empty without.
const std::vector<std::int64_t>* regions_of(const MeshDocument& document) {
    for (const char* name : {"region", "marker"})
        for (const Field& field : document.fields)
            if (field.location == Location::tetrahedra && field.name == name && field.components == 1)
                if (const auto* values = std::get_if<std::vector<std::int64_t>>(&field.values)) return values;
    return nullptr;
}

void add_boundary(TriangulatedSurface& surface, const MeshDocument& document,
                  const std::optional<std::int64_t>& region) {
    const std::vector<std::int64_t>* regions = regions_of(document);
    struct Face {
        Triangle sorted, outward;
        Index tetrahedron;
    };
    std::vector<Face> faces;
    for (std::size_t t = 0; t < document.tetrahedra.size(); ++t) {
        if (region && (regions == nullptr || (*regions)[t] != *region)) continue;
        std::vector<VertexId> v(document.tetrahedra[t].begin(), document.tetrahedra[t].end());
        require_corners(v, surface.mesh.positions.size(), static_cast<Index>(t));
        const Point3& a = surface.mesh.positions[index_of(v[0])];
        const auto from_a = [&](VertexId p) { return surface.mesh.positions[index_of(p)] - a; };
        if (dot(cross(from_a(v[1]), from_a(v[2])), from_a(v[3])) < 0.0) std::swap(v[0], v[1]);
        for (const Triangle& face : {Triangle{v[0], v[2], v[1]}, Triangle{v[0], v[1], v[3]}, Triangle{v[1], v[2], v[3]},
                                     Triangle{v[2], v[0], v[3]}}) {
            Triangle sorted = face;
            std::sort(sorted.begin(), sorted.end());
            faces.push_back({sorted, face, static_cast<Index>(t)});
        }
    }
    std::stable_sort(faces.begin(), faces.end(), [](const Face& x, const Face& y) { return x.sorted < y.sorted; });
    for (std::size_t i = 0, j = 0; i < faces.size(); i = j) {
        while (j < faces.size() && faces[j].sorted == faces[i].sorted) ++j;
        if (j - i != 1) continue;
        surface.mesh.triangles.push_back(faces[i].outward);
        surface.source_faces.push_back(faces[i].tetrahedron);
    }
}

template <class Values>
void add_field(std::vector<Field>& fields, const char* name, const Values& values) {
    if (!values.empty())
        fields.push_back({name, Location::vertices, 1, std::vector<double>(values.begin(), values.end())});
}

void add_vectors(std::vector<Field>& fields, const char* name, const std::vector<Point3>& vectors) {
    if (vectors.empty()) return;
    std::vector<double> values;
    values.reserve(3 * vectors.size());
    for (const Point3& v : vectors) values.insert(values.end(), {v.x, v.y, v.z});
    fields.push_back({name, Location::vertices, 3, std::move(values)});
}

void add_tensors(std::vector<Field>& fields, const char* name, const std::vector<SymmetricTensor3>& tensors) {
    if (tensors.empty()) return;
    std::vector<double> values;
    values.reserve(6 * tensors.size());
    for (const SymmetricTensor3& t : tensors) values.insert(values.end(), {t.xx, t.xy, t.xz, t.yy, t.yz, t.zz});
    fields.push_back({name, Location::vertices, 6, std::move(values)});
}

template <class Get>
void add_bound(std::vector<Field>& fields, const char* name, const std::vector<ApproximationBound>& bounds,
               const Get& get) {
    std::vector<double> values;
    values.reserve(bounds.size());
    for (const ApproximationBound& bound : bounds) values.push_back(get(bound));
    add_field(fields, name, values);
}

/// Why there is no surface.
std::string describe_nothing(const MeshDocument& document, const std::optional<std::int64_t>& region) {
    if (document.tetrahedra.empty() || !region) return "there are no polygons: there is no surface";
    std::string regions;
    for (const std::int64_t known : find_regions(document))
        regions += (regions.empty() ? "" : ", ") + std::to_string(known);
    return "no tetrahedron is of region " + std::to_string(*region) + "; there are regions " + regions;
}

}  // namespace

TriangulatedSurface triangulate(const PolygonMesh& mesh) {
    TriangulatedSurface surface;
    surface.mesh.positions = mesh.positions;
    add_polygons(surface, mesh.corners, mesh.offsets);
    return surface;
}

TriangulatedSurface triangulate(const MeshDocument& document, const std::optional<std::int64_t>& region) {
    TriangulatedSurface surface;
    surface.mesh.positions = document.complex.positions;
    const PiecewiseLinearComplex& complex = document.complex;
    if (!document.tetrahedra.empty()) {
        add_boundary(surface, document, region);
    } else {
        for (std::size_t f = 0; f + 1 < complex.hole_offsets.size(); ++f)
            if (complex.hole_offsets[f + 1] > complex.hole_offsets[f])
                throw InputError(
                    {{DefectKind::hole_outside_facet,
                      {{ElementKind::facet, static_cast<Index>(f)}},
                      complex.facet_holes[complex.hole_offsets[f]],
                      "facet " + std::to_string(f + 1) +
                          " has a hole: curvature takes polygons without holes; cut the facet into several"}});
        add_polygons(surface, complex.corners, complex.polygon_offsets);
    }
    if (surface.mesh.triangles.empty())
        throw InputError({{DefectKind::empty_input, {}, {}, describe_nothing(document, region)}});
    return surface;
}

std::vector<std::int64_t> find_regions(const MeshDocument& document) {
    const std::vector<std::int64_t>* regions = regions_of(document);
    if (regions == nullptr) return {};
    const std::set<std::int64_t> distinct(regions->begin(), regions->end());
    return {distinct.begin(), distinct.end()};
}

std::vector<Field> make_fields(const CurvatureResult& result) {
    std::vector<Field> fields;
    add_field(fields, "area", result.area);
    add_field(fields, "mean", result.mean);
    add_field(fields, "gaussian", result.gaussian);
    add_field(fields, "k_min", result.k_min);
    add_field(fields, "k_max", result.k_max);
    add_vectors(fields, "dir_min", result.dir_min);
    add_vectors(fields, "dir_max", result.dir_max);
    add_vectors(fields, "normal", result.normal);
    add_field(fields, "confidence", result.confidence);
    fields.push_back(
        {"flags", Location::vertices, 1, std::vector<std::int64_t>(result.flags.begin(), result.flags.end())});
    add_field(fields, "radius", result.radius);
    add_field(fields, "mean_measure", result.mean_measure);
    add_field(fields, "gaussian_measure", result.gaussian_measure);
    add_field(fields, "edge_mass", result.edge_mass);
    add_field(fields, "vertex_mass", result.vertex_mass);
    add_tensors(fields, "tensor", result.tensor);
    add_tensors(fields, "swapped_tensor", result.swapped_tensor);
    if (result.bounds.empty()) return fields;
    add_bound(fields, "bound_epsilon", result.bounds, [](const ApproximationBound& b) { return b.epsilon; });
    add_bound(fields, "bound_k", result.bounds,
              [](const ApproximationBound& b) { return b.squared_radii + b.rim_radii / b.max_curvature; });
    add_bound(fields, "bound_calibrated", result.bounds, [](const ApproximationBound& b) { return b.calibrated; });
    add_bound(fields, "bound_holds", result.bounds,
              [](const ApproximationBound& b) { return b.hypothesis_holds ? 1.0 : 0.0; });
    // Where nothing is proved there is no number; 0 stands for it beside bound_holds = 0.
    add_bound(fields, "bound_mean", result.bounds, [](const ApproximationBound& b) { return b.mean.value_or(0.0); });
    add_bound(fields, "bound_tensor", result.bounds,
              [](const ApproximationBound& b) { return b.swapped_tensor.value_or(0.0); });
    return fields;
}

}  // namespace certa
