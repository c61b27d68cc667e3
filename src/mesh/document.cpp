// Documents of conforming meshes and back, and the one way to append a facet to a complex.
// Ids leave the library counted from 1 and come back counted from 0 (docs/conventions.md); 0 in a file means "none".
#include <certa/io.h>

#include <algorithm>

namespace certa {
namespace {

using Integers = std::vector<std::int64_t>;

template <class Id>
Integers labels_from_one(const std::vector<Id>& ids) {
    Integers labels(ids.size());
    std::transform(ids.begin(), ids.end(), labels.begin(),
                   [](Id id) { return index_of(id) == no_index ? std::int64_t{0} : std::int64_t{index_of(id)} + 1; });
    return labels;
}

void add_integers(MeshDocument& document, const char* name, Location location, Integers values) {
    if (!values.empty()) document.fields.push_back({name, location, 1, std::move(values)});
}

[[noreturn]] void refuse_label(ElementKind kind, std::size_t element, ElementKind label_kind, std::uint32_t label,
                               std::size_t size) {
    const auto index = static_cast<std::uint32_t>(element);
    throw InputError({{DefectKind::index_out_of_range,
                       {{kind, index}, {label_kind, label}},
                       {},
                       std::string(name_of(kind)) + " " + std::to_string(element + 1) + " is labelled with " +
                           name_of(label_kind) + " " + std::to_string(label + std::uint64_t{1}) + " of " +
                           std::to_string(size) + "; is this the complex that the mesh was made from?"}});
}

/// The marker that each element inherits; empty if nothing is marked.
template <class Id>
std::vector<std::int32_t> inherited_markers(const std::vector<Id>& ids, const std::vector<std::int32_t>& markers) {
    std::vector<std::int32_t> inherited;
    if (markers.empty() || ids.empty()) return inherited;
    inherited.reserve(ids.size());
    for (const Id id : ids) inherited.push_back(index_of(id) < markers.size() ? markers[index_of(id)] : 0);
    if (std::all_of(inherited.begin(), inherited.end(), [](std::int32_t m) { return m == 0; })) inherited.clear();
    return inherited;
}

void add_sources(MeshDocument& document, const std::vector<VertexSource>& sources) {
    Integers kinds, indices;
    for (const VertexSource& source : sources) {
        kinds.push_back(static_cast<std::int64_t>(source.origin));
        indices.push_back(source.index == no_index ? 0 : std::int64_t{source.index} + 1);
    }
    add_integers(document, "source_kind", Location::vertices, std::move(kinds));
    add_integers(document, "source_index", Location::vertices, std::move(indices));
}

void add_region_attributes(MeshDocument& document, const std::vector<RegionId>& regions,
                           const std::vector<double>& attributes) {
    if (std::all_of(attributes.begin(), attributes.end(), [](double a) { return a == 0.0; })) return;
    std::vector<double> values;
    for (const RegionId region : regions)
        values.push_back(index_of(region) < attributes.size() ? attributes[index_of(region)] : 0.0);
    if (!values.empty()) document.fields.push_back({"region_attribute", Location::tetrahedra, 1, std::move(values)});
}

const Integers* find_integers(const MeshDocument& document, const char* name, Location location) {
    for (const Field& field : document.fields)
        if (field.location == location && field.name == name && field.components == 1)
            return std::get_if<Integers>(&field.values);
    return nullptr;
}

/// Ids from labels that count from 1; empty if no element has one.
template <class Id, class Number>
std::vector<Id> ids_from_one(const std::vector<Number>& labels) {
    std::vector<Id> ids;
    if (std::all_of(labels.begin(), labels.end(), [](Number label) { return label <= 0; })) return ids;
    ids.reserve(labels.size());
    for (const Number label : labels) {
        const auto wide = static_cast<std::int64_t>(label);
        if (wide > std::int64_t{no_index})
            throw IoError("document", 0, "the label " + std::to_string(wide) + " is no 32-bit id");
        ids.push_back(Id{wide <= 0 ? no_index : static_cast<std::uint32_t>(wide - 1)});
    }
    return ids;
}

std::vector<VertexSource> sources_of(const MeshDocument& document) {
    const Integers* kinds = find_integers(document, "source_kind", Location::vertices);
    const Integers* indices = find_integers(document, "source_index", Location::vertices);
    std::vector<VertexSource> sources;
    if (kinds == nullptr || indices == nullptr) return sources;
    for (std::size_t i = 0; i < kinds->size(); ++i) {
        const std::int64_t kind = (*kinds)[i], index = (*indices)[i];
        if (kind < 0 || kind > 2 || index < 0 || index > std::int64_t{no_index})
            throw IoError("document", 0,
                          "vertex " + std::to_string(i + 1) + " has no valid source_kind and source_index");
        sources.push_back(
            {static_cast<VertexOrigin>(kind), index == 0 ? no_index : static_cast<std::uint32_t>(index - 1)});
    }
    return sources;
}

std::vector<RegionId> regions_of(const MeshDocument& document) {
    const Integers* regions = find_integers(document, "region", Location::tetrahedra);
    if (regions == nullptr) regions = find_integers(document, "marker", Location::tetrahedra);
    std::vector<RegionId> ids;
    if (regions == nullptr) return ids;
    ids.reserve(regions->size());
    for (const std::int64_t region : *regions) {
        if (region >= std::int64_t{no_index})
            throw IoError("document", 0, "the region " + std::to_string(region) + " is no 32-bit id");
        ids.push_back(RegionId{region < 0 ? 0U : static_cast<std::uint32_t>(region)});
    }
    return ids;
}

}  // namespace

void add_facet(PiecewiseLinearComplex& complex, const std::vector<std::vector<VertexId>>& polygons,
               const std::vector<Point3>& holes) {
    for (const std::vector<VertexId>& polygon : polygons) {
        complex.corners.insert(complex.corners.end(), polygon.begin(), polygon.end());
        complex.polygon_offsets.push_back(static_cast<std::uint32_t>(complex.corners.size()));
    }
    complex.facet_holes.insert(complex.facet_holes.end(), holes.begin(), holes.end());
    complex.facet_offsets.push_back(static_cast<std::uint32_t>(complex.polygon_count()));
    complex.hole_offsets.push_back(static_cast<std::uint32_t>(complex.facet_holes.size()));
}

MeshDocument make_document(const TetMesh& mesh, const PiecewiseLinearComplex& complex, Reference reference,
                           const std::vector<double>& region_attributes) {
    for (std::size_t i = 0; i < mesh.triangle_facets.size(); ++i) {
        const std::uint32_t facet = index_of(mesh.triangle_facets[i]);
        if (facet != no_index && facet >= complex.facet_count())
            refuse_label(ElementKind::triangle, i, ElementKind::facet, facet, complex.facet_count());
    }
    MeshDocument document;
    document.reference = reference;
    PiecewiseLinearComplex& out = document.complex;
    out.positions = mesh.positions;
    out.segments = mesh.edges;
    for (const Triangle& triangle : mesh.triangles) {
        out.corners.insert(out.corners.end(), triangle.begin(), triangle.end());
        out.polygon_offsets.push_back(static_cast<std::uint32_t>(out.corners.size()));
        out.facet_offsets.push_back(static_cast<std::uint32_t>(out.polygon_count()));
    }
    out.hole_offsets.assign(mesh.triangles.size() + 1, 0);
    document.tetrahedra = mesh.tetrahedra;

    out.facet_markers = inherited_markers(mesh.triangle_facets, complex.facet_markers);
    out.segment_markers = inherited_markers(mesh.edge_segments, complex.segment_markers);
    if (!complex.point_markers.empty()) {
        out.point_markers = complex.point_markers;
        out.point_markers.resize(mesh.positions.size(), 0);
    }
    Integers regions;
    for (const RegionId region : mesh.tetrahedron_regions) regions.push_back(index_of(region));
    add_integers(document, "region", Location::tetrahedra, std::move(regions));
    add_integers(document, "facet", Location::polygons, labels_from_one(mesh.triangle_facets));
    add_integers(document, "segment", Location::segments, labels_from_one(mesh.edge_segments));
    add_sources(document, mesh.vertex_sources);
    add_region_attributes(document, mesh.tetrahedron_regions, region_attributes);
    return document;
}

TetMesh make_tet_mesh(const MeshDocument& document) {
    const PiecewiseLinearComplex& complex = document.complex;
    TetMesh mesh;
    mesh.positions = complex.positions;
    mesh.vertex_sources = sources_of(document);
    mesh.tetrahedra = document.tetrahedra;
    mesh.tetrahedron_regions = regions_of(document);
    mesh.triangles.reserve(complex.polygon_count());
    for (std::size_t i = 0; i < complex.polygon_count(); ++i) {
        const std::uint32_t first = complex.polygon_offsets[i], degree = complex.polygon_offsets[i + 1] - first;
        if (degree != 3)
            throw IoError("document", 0,
                          "polygon " + std::to_string(i + 1) + " has " + std::to_string(degree) +
                              " corners; the faces of a tetrahedral mesh are triangles");
        mesh.triangles.push_back({complex.corners[first], complex.corners[first + 1], complex.corners[first + 2]});
    }
    mesh.edges = complex.segments;
    const Integers* facets = find_integers(document, "facet", Location::polygons);
    const Integers* segments = find_integers(document, "segment", Location::segments);
    mesh.triangle_facets =
        facets != nullptr ? ids_from_one<FacetId>(*facets) : ids_from_one<FacetId>(complex.facet_markers);
    mesh.edge_segments =
        segments != nullptr ? ids_from_one<SegmentId>(*segments) : ids_from_one<SegmentId>(complex.segment_markers);
    return mesh;
}

}  // namespace certa
