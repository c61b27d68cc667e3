// TetGen's text files, written with indices from 1. Segments follow the facets of a .poly or .smesh as facets of one
// polygon of two corners, which is how TetGen knows them; the reader turns them back.
#include "io/document_parts.h"
#include "io/formats.h"
#include "io/text_output.h"

namespace certa::io {
namespace {

void write_points(TextOutput& out, const MeshDocument& document) {
    const PiecewiseLinearComplex& complex = document.complex;
    const Field* attribute = find_field(document, "attribute", Location::vertices);
    const std::uint32_t components = attribute != nullptr ? attribute->components : 0;
    out << complex.positions.size() << " 3 " << components << (complex.point_markers.empty() ? " 0\n" : " 1\n");
    for (std::size_t i = 0; i < complex.positions.size(); ++i) {
        out << i + 1 << ' ' << complex.positions[i];
        for (std::uint32_t k = 0; k < components; ++k)
            out << ' ' << std::get<std::vector<double>>(attribute->values)[i * components + k];
        if (!complex.point_markers.empty()) out << ' ' << complex.point_markers[i];
        out << '\n';
    }
}

void write_corners(TextOutput& out, std::span<const VertexId> corners) {
    out << corners.size();
    for (const VertexId corner : corners) out << ' ' << index_of(corner) + 1ULL;
}

void write_point_row(TextOutput& out, std::size_t number, const Point3& place) { out << number << ' ' << place; }

void write_facet(TextOutput& out, const PiecewiseLinearComplex& complex, std::size_t facet, bool has_markers) {
    const std::uint32_t first = complex.facet_offsets[facet], last = complex.facet_offsets[facet + 1];
    const std::uint32_t first_hole = complex.hole_offsets[facet], last_hole = complex.hole_offsets[facet + 1];
    out << last - first << ' ' << last_hole - first_hole;
    if (has_markers) out << ' ' << marker_of(complex.facet_markers, facet);
    out << '\n';
    for (std::uint32_t polygon = first; polygon < last; ++polygon) {
        write_corners(out, polygon_corners(complex, polygon));
        out << '\n';
    }
    for (std::uint32_t hole = first_hole; hole < last_hole; ++hole) {
        write_point_row(out, hole - first_hole + std::size_t{1}, complex.facet_holes[hole]);
        out << '\n';
    }
}

void write_region_points(TextOutput& out, const PiecewiseLinearComplex& complex) {
    out << complex.region_holes.size() << '\n';
    for (std::size_t i = 0; i < complex.region_holes.size(); ++i) {
        write_point_row(out, i + 1, complex.region_holes[i]);
        out << '\n';
    }
    out << complex.region_seeds.size() << '\n';
    for (std::size_t i = 0; i < complex.region_seeds.size(); ++i) {
        const RegionSeed& seed = complex.region_seeds[i];
        write_point_row(out, i + 1, seed.place);
        out << ' ' << seed.attribute << ' ' << seed.max_volume << '\n';
    }
}

std::string write_complex(const MeshDocument& document, bool simple) {
    const PiecewiseLinearComplex& complex = document.complex;
    const bool has_markers = !complex.facet_markers.empty() || !complex.segment_markers.empty();
    TextOutput out;
    out.reserve(complex.positions.size() * 72 + complex.corners.size() * 12);
    write_points(out, document);
    out << complex.facet_count() + complex.segments.size() << (has_markers ? " 1\n" : " 0\n");
    for (std::size_t facet = 0; facet < complex.facet_count(); ++facet) {
        if (!simple) {
            write_facet(out, complex, facet, has_markers);
            continue;
        }
        write_corners(out, polygon_corners(complex, complex.facet_offsets[facet]));
        if (has_markers) out << ' ' << marker_of(complex.facet_markers, facet);
        out << '\n';
    }
    for (std::size_t i = 0; i < complex.segments.size(); ++i) {
        const std::int32_t marker = marker_of(complex.segment_markers, i);
        if (!simple) {
            out << "1 0";
            if (has_markers) out << ' ' << marker;
            out << '\n';
        }
        write_corners(out, complex.segments[i]);
        if (simple && has_markers) out << ' ' << marker;
        out << '\n';
    }
    write_region_points(out, complex);
    return out.take();
}

std::string write_tetrahedra(const MeshDocument& document, const std::vector<std::int64_t>& regions) {
    const Field* attribute = find_field(document, "attribute", Location::tetrahedra);
    const std::uint32_t components = attribute != nullptr ? attribute->components : 0;
    TextOutput out;
    out << document.tetrahedra.size() << " 4 " << components + (regions.empty() ? 0U : 1U) << '\n';
    for (std::size_t i = 0; i < document.tetrahedra.size(); ++i) {
        out << i + 1;
        for (const VertexId corner : document.tetrahedra[i]) out << ' ' << index_of(corner) + 1ULL;
        if (!regions.empty()) out << ' ' << regions[i];
        for (std::uint32_t k = 0; k < components; ++k)
            out << ' ' << std::get<std::vector<double>>(attribute->values)[i * components + k];
        out << '\n';
    }
    return out.take();
}

template <class CornersOf>
std::string write_cells(std::size_t count, const std::vector<std::int64_t>& markers, const CornersOf& corners_of) {
    TextOutput out;
    out << count << (markers.empty() ? " 0\n" : " 1\n");
    for (std::size_t i = 0; i < count; ++i) {
        out << i + 1;
        for (const VertexId corner : corners_of(i)) out << ' ' << index_of(corner) + 1ULL;
        if (!markers.empty()) out << ' ' << markers[i];
        out << '\n';
    }
    return out.take();
}

}  // namespace

std::string write_poly(const MeshDocument& document) { return write_complex(document, false); }
std::string write_smesh(const MeshDocument& document) { return write_complex(document, true); }

NodeSet write_node_set(const MeshDocument& document) {
    const PiecewiseLinearComplex& complex = document.complex;
    const ElementNumbers numbers = choose_element_numbers(document);
    TextOutput nodes;
    if (!document.remark.empty()) nodes << "# " << remark_line(document) << '\n';
    write_points(nodes, document);
    return {nodes.take(), write_tetrahedra(document, numbers.tetrahedra),
            write_cells(complex.polygon_count(), numbers.polygons,
                        [&](std::size_t i) { return polygon_corners(complex, i); }),
            write_cells(complex.segments.size(), numbers.segments,
                        [&](std::size_t i) { return std::span<const VertexId>(complex.segments[i]); })};
}

}  // namespace certa::io
