// Documents of conforming meshes: make_document, every volume format, make_tet_mesh, and what the labels become.
#include "documents.h"

namespace certa::test {
namespace {

/// Two tetrahedra on either side of a marked triangle, with a Steiner point; not Delaunay, which nobody here asks for.
struct Sample {
    PiecewiseLinearComplex complex;
    TetMesh mesh;
};

Sample make_sample(bool with_markers) {
    Sample sample;
    const auto v = [](std::uint32_t i) { return VertexId{i}; };
    PiecewiseLinearComplex& complex = sample.complex;
    complex.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0.1, 0.2, 1.0 / 3.0}};
    add_facet(complex, {{v(0), v(1), v(2)}});
    add_facet(complex, {{v(0), v(1), v(3)}});
    complex.segments = {{v(0), v(3)}};
    if (with_markers) {
        complex.point_markers = {5, 0, -6, 7};
        complex.facet_markers = {-3, 40};
        complex.segment_markers = {11};
    }
    TetMesh& mesh = sample.mesh;
    mesh.positions = complex.positions;
    mesh.positions.push_back({0.25, 0.25, -1e-300});
    mesh.vertex_sources.assign(4, {});
    for (std::uint32_t i = 0; i < 4; ++i) mesh.vertex_sources[i].index = i;
    mesh.vertex_sources.push_back({VertexOrigin::facet, 1});
    mesh.tetrahedra = {{v(0), v(1), v(2), v(3)}, {v(0), v(2), v(1), v(4)}, {v(1), v(2), v(3), v(4)}};
    mesh.tetrahedron_regions = {RegionId{1}, RegionId{0}, RegionId{2}};
    mesh.triangles = {{v(0), v(1), v(2)}, {v(0), v(1), v(3)}, {v(0), v(1), v(2)}};
    mesh.triangle_facets = {FacetId{0}, FacetId{1}, FacetId{1}};
    mesh.edges = {{v(0), v(3)}, {v(1), v(2)}};
    mesh.edge_segments = {SegmentId{0}, SegmentId{4}};
    return sample;
}

void expect_same_mesh(const TetMesh& read, const TetMesh& written, bool with_sources) {
    expect_same_numbers(read.positions, written.positions, "positions");
    EXPECT_EQ(read.tetrahedra, written.tetrahedra);
    EXPECT_EQ(read.tetrahedron_regions, written.tetrahedron_regions);
    EXPECT_EQ(read.triangles, written.triangles);
    EXPECT_EQ(read.triangle_facets, written.triangle_facets);
    EXPECT_EQ(read.edges, written.edges);
    EXPECT_EQ(read.edge_segments, written.edge_segments);
    EXPECT_EQ(read.vertex_sources, with_sources ? written.vertex_sources : std::vector<VertexSource>());
}

TEST(ConformDocument, MakeTetMeshInvertsMakeDocument) {
    for (const bool with_markers : {false, true})
        for (const Reference reference : {Reference::id, Reference::marker}) {
            const Sample sample = make_sample(with_markers);
            const MeshDocument document = make_document(sample.mesh, sample.complex, reference, {0, 2.5, -7});
            expect_same_mesh(make_tet_mesh(document), sample.mesh, true);
            EXPECT_EQ(document.complex.facet_markers,
                      with_markers ? (std::vector<std::int32_t>{-3, 40, 40}) : std::vector<std::int32_t>());
            EXPECT_EQ(document.complex.segment_markers,
                      with_markers ? (std::vector<std::int32_t>{11, 0}) : std::vector<std::int32_t>());
            EXPECT_EQ(document.complex.point_markers,
                      with_markers ? (std::vector<std::int32_t>{5, 0, -6, 7, 0}) : std::vector<std::int32_t>());
        }
}

TEST(ConformDocument, EveryVolumeFormatCarriesTheIds) {
    for (const bool with_markers : {false, true}) {
        const Sample sample = make_sample(with_markers);
        const MeshDocument document = make_document(sample.mesh, sample.complex, Reference::id, {0, 2.5, -7});
        for (const Format format : {Format::medit, Format::vtu, Format::msh})
            for (const bool version_2 : {false, true}) {
                if (version_2 && format != Format::msh) continue;
                const MeshDocument back =
                    parse_document(format_document(document, format, {.msh_version_2 = version_2}), format);
                expect_same_mesh(make_tet_mesh(back), sample.mesh, format != Format::medit);
                // VTU and msh carry everything, the other ones one number per element.
                if (format != Format::medit) expect_same(document, back);
            }
    }
}

TEST(ConformDocument, ReferencesOfMedit) {
    const Sample sample = make_sample(true);
    const auto text = [&](Reference reference) {
        return format_document(make_document(sample.mesh, sample.complex, reference), Format::medit);
    };
    EXPECT_EQ(text(Reference::id),
              "MeshVersionFormatted 2\nDimension 3\n\nVertices\n5\n0 0 0 5\n1 0 0 0\n0 1 0 -6\n"
              "0.1 0.2 0.3333333333333333 7\n0.25 0.25 -1e-300 0\n\nEdges\n2\n1 4 1\n2 3 5\n"
              "\nTriangles\n3\n1 2 3 1\n1 2 4 2\n1 2 3 2\n\nTetrahedra\n3\n1 2 3 4 1\n1 3 2 5 0\n2 3 4 5 2\n\nEnd\n");
    const std::string by_marker = text(Reference::marker);
    EXPECT_NE(by_marker.find("Edges\n2\n1 4 11\n2 3 0\n"), std::string::npos);
    EXPECT_NE(by_marker.find("Triangles\n3\n1 2 3 -3\n1 2 4 40\n1 2 3 40\n"), std::string::npos);
    EXPECT_NE(by_marker.find("Tetrahedra\n3\n1 2 3 4 1\n"), std::string::npos);
}

TEST(ConformDocument, GmshSeesReferencesAsPhysicalTags) {
    const Sample sample = make_sample(true);
    const auto text = [&](Reference reference) {
        return format_document(make_document(sample.mesh, sample.complex, reference), Format::msh,
                               {.msh_version_2 = true});
    };
    EXPECT_NE(
        text(Reference::id).find("$Elements\n8\n1 1 2 1 1 1 4\n2 1 2 5 5 2 3\n3 2 2 1 1 1 2 3\n4 2 2 2 2 1 2 4\n"),
        std::string::npos);
    // Elements without a positive number share an entity beyond the others and have no physical tag.
    EXPECT_NE(text(Reference::marker).find("3 2 2 0 41 1 2 3\n4 2 2 40 40 1 2 4\n"), std::string::npos);
}

TEST(ConformDocument, NodeSetCarriesOneNumberPerElement) {
    const Sample sample = make_sample(true);
    char pattern[] = "/tmp/certa-io-XXXXXX";
    ASSERT_NE(::mkdtemp(pattern), nullptr);
    const std::string path = std::string(pattern) + "/a.node";
    write_document(path, make_document(sample.mesh, sample.complex, Reference::id));
    expect_same_mesh(make_tet_mesh(read_document(path)), sample.mesh, false);
    for (const char* name : {"/a.node", "/a.ele", "/a.face", "/a.edge"})
        ::unlink((pattern + std::string(name)).c_str());
    ::rmdir(pattern);
}

TEST(ConformDocument, ForeignMeshesHaveNoLabels) {
    const TetMesh mesh =
        make_tet_mesh(parse_document("MeshVersionFormatted 2\nDimension 3\nVertices 4\n0 0 0 0\n1 0 0 0\n0 1 0 0\n0 0 "
                                     "1 0\nTriangles 2\n1 2 3 0\n1 2 4 0\n"
                                     "Edges 2\n1 2 -4\n2 3 7\nTetrahedra 1\n1 2 3 4 0\n",
                                     Format::medit));
    EXPECT_TRUE(mesh.triangle_facets.empty());
    EXPECT_EQ(mesh.edge_segments, (std::vector<SegmentId>{SegmentId{no_index}, SegmentId{6}}));
    EXPECT_TRUE(mesh.tetrahedron_regions.empty());
    EXPECT_TRUE(mesh.vertex_sources.empty());
}

TEST(ConformDocument, RefusesWhatDoesNotFit) {
    Sample sample = make_sample(false);
    sample.mesh.triangle_facets[1] = FacetId{2};
    EXPECT_THROW(make_document(sample.mesh, sample.complex, Reference::id), InputError);
    MeshDocument quad;
    quad.complex.positions = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
    add_facet(quad.complex, {{VertexId{0}, VertexId{1}, VertexId{2}, VertexId{3}}});
    EXPECT_THROW(make_tet_mesh(quad), IoError);
}

TEST(AddFacet, KeepsTheLayout) {
    PiecewiseLinearComplex complex;
    const auto v = [](std::uint32_t i) { return VertexId{i}; };
    add_facet(complex, {{v(0), v(1), v(2)}, {v(3), v(4)}}, {{1, 2, 3}});
    add_facet(complex, {{v(5)}});
    EXPECT_EQ(complex.facet_count(), 2U);
    EXPECT_EQ(complex.polygon_count(), 3U);
    EXPECT_EQ(complex.polygon_offsets, (std::vector<std::uint32_t>{0, 3, 5, 6}));
    EXPECT_EQ(complex.facet_offsets, (std::vector<std::uint32_t>{0, 2, 3}));
    EXPECT_EQ(complex.hole_offsets, (std::vector<std::uint32_t>{0, 1, 1}));
}

}  // namespace
}  // namespace certa::test
