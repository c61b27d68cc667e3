// What the readers understand beyond what our writers write: the dialects of docs/formats.md, one small file each.
#include <algorithm>
#include <cstring>

#include "documents.h"
#include "io/base64.h"
#include "io/inflate.h"

namespace certa::test {
namespace {

std::vector<std::vector<unsigned>> polygons_of(const MeshDocument& document) {
    std::vector<std::vector<unsigned>> polygons;
    const PiecewiseLinearComplex& complex = document.complex;
    for (std::size_t i = 0; i < complex.polygon_count(); ++i) {
        polygons.emplace_back();
        for (std::uint32_t k = complex.polygon_offsets[i]; k < complex.polygon_offsets[i + 1]; ++k)
            polygons.back().push_back(index_of(complex.corners[k]));
    }
    return polygons;
}
std::vector<std::vector<unsigned>> segments_of(const MeshDocument& document) {
    std::vector<std::vector<unsigned>> segments;
    for (const Edge& edge : document.complex.segments) segments.push_back({index_of(edge[0]), index_of(edge[1])});
    return segments;
}
using Lists = std::vector<std::vector<unsigned>>;

// --- OFF ---

TEST(Off, ReadsPrefixesColoursCommentsAndLineEnds) {
    const Lists triangle{{0, 1, 2}};
    const char* const all_prefixes =
        "STCNOFF\n3 1 0\n0 0 0 0 0 1 255 0 0 255 0.5 0.5\n1 0 0 0 0 1 1 1 1 1 0 0\n0 1 0 0 0 1 1 1 1 1 0 0\n3 0 1 2\n";
    for (const char* text : {
             "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n",
             "OFF 3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2",
             "3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n",
             "OFF # comment\n\n3 1\n# more\n0 0 0 # a\n1 0 0\n0 1 0\n\n3 0 1 2\n# end\n",
             "\xEF\xBB\xBFOFF\r\n3 1 0\r\n0 0 0\r\n1 0 0\r\n0 1 0\r\n3 0 1 2\r\n",
             "OFF\r3 1 0\r0 0 0\r1 0 0\r0 1 0\r3 0 1 2\r",
             "COFF\n3 1 0\n0 0 0 255 0 0 255\n1 0 0 0 1 0\n0 1 0 0.5 0.5 0.5 1\n3 0 1 2\n",
             "NOFF\n3 1 0\n0 0 0 0 0 1\n1 0 0 0 0 1\n0 1 0\n0 0 1\n3 0 1 2\n",
             all_prefixes,
             "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2 0.5 0.5 0.5 1\n",
             "OFF\n3 1 0\n0 0\n0\n1 0 0\n0 1 0\n3\n0\n1 2 7\n",
             "OFF\n3 1 0\n+0 0. .0\n1e0 0 0\n0 1.0E+0 0\n3 +0 1 2\n",
         }) {
        const MeshDocument document = parse_document(text, Format::off);
        EXPECT_EQ(polygons_of(document), triangle) << text;
        ASSERT_EQ(document.complex.positions.size(), 3U);
        EXPECT_EQ(document.complex.positions[1], (Point3{1, 0, 0})) << text;
        EXPECT_EQ(document.complex.positions[2], (Point3{0, 1, 0})) << text;
    }
    EXPECT_EQ(parse_document("COFF\n1 0 0\n0 0 0 1 1 1 1\n", Format::off).notes.size(), 1U);
    EXPECT_TRUE(parse_document("OFF\n1 0 0\n0 0 0\n", Format::off).notes.empty());
}

TEST(Off, KeepsSmallFacesAsTheFileHasThem) {
    const MeshDocument document = parse_document("OFF\n2 3 0\n0 0 0\n1 0 0\n2 0 1\n1 1\n3 0 0 1\n", Format::off);
    EXPECT_EQ(polygons_of(document), (Lists{{0, 1}, {1}, {0, 0, 1}}));
    EXPECT_EQ(document.complex.facet_count(), 3U);
}

TEST(Off, ReadsNumbersAsTheNearestDoubles) {
    const MeshDocument document = parse_document(
        "OFF\n3 0 0\n1e-400 -1e-400 0.1\n2.2250738585072012e-308 4.9406564584124654e-324 1e308\n"
        "0.000000000000000000000000000000000000000000000000000001e54 9007199254740993 1.7976931348623157e308\n",
        Format::off);
    const auto& p = document.complex.positions;
    EXPECT_TRUE(same_bits(p[0], {0.0, -0.0, 0.1}));
    EXPECT_TRUE(same_bits(p[1], {std::numeric_limits<double>::min(), 5e-324, 1e308}));
    EXPECT_TRUE(same_bits(p[2], {1.0, 9007199254740992.0, std::numeric_limits<double>::max()}));
}

// --- OBJ ---

TEST(Obj, ReadsCornersContinuationsNegativeIndicesAndLines) {
    const MeshDocument document = parse_document(
        "# comment\r\nmtllib a.mtl\no thing\nv 0 0 0 1\nv 1 0 0 0.1 0.2 nan\nv 0 1 0\n"
        "v 0 0 \\\n 1\nvn 0 0 1\nvt 0 0\ng a b\nusemtl m\ns off\nf 1/1/1 3//1 2/1\nf -4 -3 -1\nf 1 2 \\\r\n 3\\\n 4\nl "
        "1 2 3\nl 4/1 1/1\np 1\n"
        "f 1 5 2\nv 7 7 7",
        Format::obj);
    EXPECT_EQ(polygons_of(document), (Lists{{0, 2, 1}, {0, 1, 3}, {0, 1, 2, 3}, {0, 4, 1}}));
    EXPECT_EQ(segments_of(document), (Lists{{0, 1}, {1, 2}, {3, 0}}));
    EXPECT_EQ(document.complex.positions[3], (Point3{0, 0, 1}));
    EXPECT_EQ(document.complex.facet_count(), 4U);
    ASSERT_EQ(document.notes.size(), 1U);
    EXPECT_EQ(document.notes[0],
              "colours of vertices, groups, materials, normals, object names, point elements and texture coordinates "
              "are left out");
    // Only what is there is named.
    const MeshDocument named = parse_document("o part\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", Format::obj);
    EXPECT_EQ(named.notes, std::vector<std::string>{"object names are left out"});
}

// --- PLY ---

template <class T>
void put(std::string& out, T value, bool big) {
    char bytes[sizeof(T)];
    std::memcpy(bytes, &value, sizeof(T));
    if (big) std::reverse(bytes, bytes + sizeof(T));
    out.append(bytes, sizeof(T));
}

TEST(Ply, ReadsBothByteOrders) {
    for (const bool big : {false, true}) {
        std::string text =
            std::string("ply\r\nformat ") + (big ? "binary_big_endian" : "binary_little_endian") +
            " 1.0\r\ncomment made by hand\r\nelement vertex 3\r\nproperty float x\r\nproperty double y\r\n"
            "property short z\r\nproperty uchar red\r\nproperty list uchar float weights\r\n"
            "element thing 1\r\nproperty list ushort double stuff\r\nproperty char c\r\n"
            "element face 1\r\nproperty list int uint vertex_indices\r\nproperty float quality\r\nend_header\r\n";
        for (int i = 0; i < 3; ++i) {
            put(text, static_cast<float>(i) + 0.5F, big);
            put(text, 0.1 * i, big);
            put(text, static_cast<std::int16_t>(-300 * i), big);
            put(text, static_cast<std::uint8_t>(200 + i), big);
            put(text, static_cast<std::uint8_t>(i), big);
            for (int k = 0; k < i; ++k) put(text, 1.0F, big);
        }
        put(text, static_cast<std::uint16_t>(2), big);
        put(text, 1.0, big);
        put(text, 2.0, big);
        put(text, static_cast<std::int8_t>(-1), big);
        put(text, std::int32_t{3}, big);
        for (const std::uint32_t v : {2U, 0U, 1U}) put(text, v, big);
        put(text, 0.25F, big);
        const MeshDocument document = parse_document(text, Format::ply);
        EXPECT_EQ(polygons_of(document), (Lists{{2, 0, 1}}));
        EXPECT_TRUE(same_bits(document.complex.positions[2], {2.5, 0.2, -600.0}));
        ASSERT_EQ(document.fields.size(), 2U);
        EXPECT_EQ(document.fields[0].name, "red");
        EXPECT_EQ(std::get<std::vector<std::int64_t>>(document.fields[0].values),
                  (std::vector<std::int64_t>{200, 201, 202}));
        EXPECT_EQ(std::get<std::vector<double>>(document.fields[1].values), (std::vector<double>{0.25}));
        EXPECT_EQ(document.notes.size(), 2U);

        EXPECT_EQ(refusal(text + "x", Format::ply).reason().substr(0, 9), "more data");
        EXPECT_NE(refusal(text.substr(0, text.size() - 1), Format::ply).reason().find("ends where"), std::string::npos);
    }
}

TEST(Ply, ReadsTristripsEdgesAndVectors) {
    const MeshDocument document = parse_document(
        "ply\nformat ascii 1.0\nobj_info x\nelement vertex 5\nproperty float x\nproperty float y\nproperty float z\n"
        "property float nx\nproperty float ny\nproperty float nz\nproperty double v_x\nproperty double v_y\nproperty "
        "double v_z\n"
        "element tristrips 1\nproperty list int int vertex_indices\nelement edge 1\nproperty int vertex1\nproperty int "
        "vertex2\n"
        "property int marker\nend_header\n"
        "0 0 0 0 0 1 1 2 3\n1 0 0 0 0 1 1 2 3\n0 1 0 0 0 1 1 2 3\n1 1 0 0 0 1 1 2 3\n2 2 0 0 0 1 1 2 3\n\n"
        "10 0 1 2 3 3 4 -1 2 1 0\n0 4 -9\n",
        Format::ply);
    EXPECT_EQ(polygons_of(document), (Lists{{0, 1, 2}, {2, 1, 3}, {2, 1, 0}}));
    EXPECT_EQ(segments_of(document), (Lists{{0, 4}}));
    EXPECT_EQ(document.complex.segment_markers, (std::vector<std::int32_t>{-9}));
    ASSERT_EQ(document.fields.size(), 2U);
    EXPECT_EQ(document.fields[0].name, "normal");
    EXPECT_EQ(document.fields[1].name, "v");
    EXPECT_EQ(document.fields[1].components, 3U);
}

TEST(Ply, ElementsWithoutPropertiesTakeNoTime) {
    const MeshDocument document = parse_document(
        "ply\nformat binary_little_endian 1.0\nelement vertex 0\nproperty float x\nproperty float y\nproperty float z\n"
        "element nothing 4294967294\nend_header\n",
        Format::ply);
    EXPECT_TRUE(document.complex.positions.empty());
}

// --- STL ---

TEST(Stl, MergesEqualCoordinatesAndReadsSeveralSolids) {
    const MeshDocument document = parse_document(
        "SOLID a b c\r\n FACET NORMAL nan nan nan\r\n OUTER LOOP\r\n VERTEX 0 0 0\r\n VERTEX 1 0 0\r\n VERTEX 0 1 0\r\n"
        " ENDLOOP\r\n ENDFACET\r\nENDSOLID a b c\r\nsolid\r\nfacet normal 0 0 1\nouter loop\nvertex -0 0 0\nvertex 0 1 "
        "0\n"
        "vertex 1 0 5e-324\nendloop\nendfacet\nendsolid",
        Format::stl);
    EXPECT_EQ(polygons_of(document), (Lists{{0, 1, 2}, {0, 2, 3}}));
    EXPECT_EQ(document.notes.size(), 1U);
}

TEST(Stl, TellsBinaryFromTextByTheSize) {
    std::string text = "solid but binary";
    text.resize(80, ' ');
    put(text, std::uint32_t{1}, false);
    for (int i = 0; i < 12; ++i) put(text, static_cast<float>(i), false);
    put(text, std::uint16_t{7}, false);
    const MeshDocument document = parse_document(text, Format::stl);
    EXPECT_EQ(polygons_of(document), (Lists{{0, 1, 2}}));
    EXPECT_EQ(document.complex.positions[2], (Point3{9, 10, 11}));
    EXPECT_EQ(document.notes.size(), 1U);
    EXPECT_EQ(refusal(text + "x", Format::stl).path(), "file");
    float nan = std::numeric_limits<float>::quiet_NaN();
    std::memcpy(text.data() + 96, &nan, 4);
    EXPECT_NE(refusal(text, Format::stl).reason().find("triangle 1 is not finite"), std::string::npos);
}

// --- TetGen ---

TEST(Poly, ReadsHolesRegionsMarkersAndBothBases) {
    for (const int base : {0, 1}) {
        std::string text = "# part 1\n 4 3 1 1 # four points\n";
        const auto index = [&](int i) { return std::to_string(base + i); };
        for (int i = 0; i < 4; ++i)
            text += index(i) + " " + std::to_string(i % 2) + " " + std::to_string(i / 2) + " 0  0.5 " +
                    std::to_string(i) + "\n";
        text += "# part 2\n3 1\n2 1 -5 # polygons holes marker\n4 " + index(0) + " " + index(1) + "\n" + index(3) +
                " " + index(2) + "\n2 " + index(0) + " " + index(3) + "\n1 0.25 0.25 0\n1 0 9\n2 " + index(0) + " " +
                index(1) + "\n1\n3 " + index(0) + " " + index(1) + " " + index(2) +
                "\n1\n1 5 5 5\n2\n1 0 0 1 7 0.5\n2 0 0 2\n";
        const MeshDocument document = parse_document(text, Format::poly);
        const PiecewiseLinearComplex& complex = document.complex;
        EXPECT_EQ(polygons_of(document), (Lists{{0, 1, 3, 2}, {0, 3}, {0, 1, 2}}));
        EXPECT_EQ(complex.facet_offsets, (std::vector<std::uint32_t>{0, 2, 3}));
        EXPECT_EQ(complex.hole_offsets, (std::vector<std::uint32_t>{0, 1, 1}));
        EXPECT_EQ(complex.facet_markers, (std::vector<std::int32_t>{-5, 0}));
        EXPECT_EQ(segments_of(document), (Lists{{0, 1}}));
        EXPECT_EQ(complex.segment_markers, (std::vector<std::int32_t>{9}));
        EXPECT_EQ(complex.point_markers, (std::vector<std::int32_t>{0, 1, 2, 3}));
        ASSERT_EQ(complex.region_seeds.size(), 2U);
        EXPECT_EQ(complex.region_seeds[0].attribute, 7);
        EXPECT_EQ(complex.region_seeds[0].max_volume, 0.5);
        EXPECT_EQ(complex.region_holes, (std::vector<Point3>{{5, 5, 5}}));
        ASSERT_EQ(document.fields.size(), 1U);
        EXPECT_EQ(document.fields[0].name, "attribute");
    }
}

TEST(Smesh, LaterPartsMayBeMissing) {
    const MeshDocument document =
        parse_document("3 3\n0 0 0 0\n1 1 0 0\n2 0 1 0\n2 1\n3 0 1\n2 4\n2 0 1 -1\n", Format::smesh);
    EXPECT_EQ(polygons_of(document), (Lists{{0, 1, 2}}));
    EXPECT_EQ(document.complex.facet_markers, (std::vector<std::int32_t>{4}));
    EXPECT_EQ(segments_of(document), (Lists{{0, 1}}));
    EXPECT_EQ(document.complex.segment_markers, (std::vector<std::int32_t>{-1}));
}

// --- Medit ---

TEST(Medit, ReadsSectionsInAnyOrderAndCase) {
    const MeshDocument document = parse_document(
        "meshversionformatted 1\n# comment\nDimension\n3\nTetrahedra 1\n1 2 3 4 -7\nEdges 1 1 2 5\nVertices\n4\n0 0 0 "
        "0\n"
        "1 0 0 0\n0 1 0 0\n0 0 1 0\nTriangles\n1\n1 3 2 0\nQuadrilaterals 1\n1 2 3 4 6\nCorners 2\n1 2\nRidges 1 "
        "1\nHexahedra 0\nEnd\n",
        Format::medit);
    EXPECT_EQ(polygons_of(document), (Lists{{0, 2, 1}, {0, 1, 2, 3}}));
    EXPECT_EQ(document.complex.facet_markers, (std::vector<std::int32_t>{0, 6}));
    EXPECT_TRUE(document.complex.point_markers.empty());
    EXPECT_EQ(document.complex.segment_markers, (std::vector<std::int32_t>{5}));
    ASSERT_EQ(document.fields.size(), 1U);
    EXPECT_EQ(std::get<std::vector<std::int64_t>>(document.fields[0].values), (std::vector<std::int64_t>{-7}));
    EXPECT_EQ(document.notes.size(), 2U);
}

// --- msh ---

TEST(Msh, TagsAreMarkersWhereNothingElseSaysMore) {
    const std::string head =
        "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n1\n2 7 \"wall\"\n$EndPhysicalNames\n"
        "$Nodes\n4\n10 0 0 0\n7 1 0 0\n900000000 0 1 0\n11 0 0 1\n$EndNodes\n";
    const MeshDocument physical = parse_document(head +
                                                     "$Elements\n4\n1 2 2 7 3 10 7 900000000\n2 2 2 0 4 10 7 11\n3 4 3 "
                                                     "2 1 0 10 7 900000000 11\n4 15 2 0 1 10\n$EndElements\n",
                                                 Format::msh);
    EXPECT_EQ(polygons_of(physical), (Lists{{0, 1, 2}, {0, 1, 3}}));
    EXPECT_EQ(physical.complex.facet_markers, (std::vector<std::int32_t>{7, 0}));
    ASSERT_EQ(physical.fields.size(), 1U);
    EXPECT_EQ(physical.fields[0].name, "marker");
    EXPECT_EQ(physical.fields[0].location, Location::tetrahedra);
    EXPECT_EQ(physical.notes.size(), 3U);  // names, elementary tags, the point element
    const MeshDocument elementary =
        parse_document(head + "$Elements\n2\n1 2 2 0 3 10 7 11\n2 2 2 0 4 10 7 11\n$EndElements\n", Format::msh);
    EXPECT_EQ(elementary.complex.facet_markers, (std::vector<std::int32_t>{3, 4}));
    const MeshDocument none =
        parse_document(head + "$Elements\n2\n1 2 2 0 3 10 7 11\n2 2 2 0 3 10 7 11\n$EndElements\n", Format::msh);
    EXPECT_TRUE(none.complex.facet_markers.empty());
}

TEST(Msh, Reads41WithEntitiesParametricNodesAndPartialData) {
    const MeshDocument document = parse_document(
        "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$Entities\n1 0 1 0\n5 0 0 0 0\n3 0 0 0 1 1 0 1 42 2 1 -2\n$EndEntities\n"
        "$Nodes\n2 3 1 3\n0 5 0 1\n1\n0 0 0\n2 3 1 2\n2\n3\n1 0 0 0.5 0.5\n0 1 0 0.25 0.5\n$EndNodes\n"
        "$Elements\n2 2 1 2\n0 5 15 1\n1 1\n2 3 2 1\n2 1 2 3\n$EndElements\n"
        "$NodeData\n2\n\"a\"\n\"scheme\"\n1\n0.5\n4\n0\n3\n1\n0\n3 1 2 3\n$EndNodeData\n"
        "$ElementData\n1\n\"b\"\n1\n0\n3\n0\n1\n1\n2 1.5\n$EndElementData\n$Periodic\n0\n$EndPeriodic\n",
        Format::msh);
    EXPECT_EQ(polygons_of(document), (Lists{{0, 1, 2}}));
    EXPECT_EQ(document.complex.positions[2], (Point3{0, 1, 0}));
    EXPECT_EQ(document.complex.facet_markers, (std::vector<std::int32_t>{42}));
    ASSERT_EQ(document.fields.size(), 2U);
    EXPECT_EQ(std::get<std::vector<double>>(document.fields[0].values),
              (std::vector<double>{0, 0, 0, 0, 0, 0, 1, 2, 3}));
    EXPECT_EQ(std::get<std::vector<double>>(document.fields[1].values), (std::vector<double>{1.5}));
}

TEST(Msh, ReadsTheOtherByteOrder) {
    std::string text = "$MeshFormat\n2.2 1 8\n";
    put(text, std::int32_t{1}, true);
    text += "\n$EndMeshFormat\n$Nodes\n3\n";
    for (int i = 0; i < 3; ++i) {
        put(text, std::int32_t{i + 1}, true);
        for (const double c : {0.1 * i, 1.0, -0.0}) put(text, c, true);
    }
    text += "\n$EndNodes\n$Elements\n1\n";
    for (const std::int32_t n : {2, 1, 2, 17, 5, 9, 1, 3, 2}) put(text, n, true);
    text += "\n$EndElements\n";
    const MeshDocument document = parse_document(text, Format::msh);
    EXPECT_EQ(polygons_of(document), (Lists{{0, 2, 1}}));
    EXPECT_TRUE(same_bits(document.complex.positions[2], {0.2, 1.0, -0.0}));
    EXPECT_EQ(document.complex.facet_markers, (std::vector<std::int32_t>{5}));
}

TEST(Msh, ArraysThatStateFewRowsCannotExhaustMemory) {
    std::string text = "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n1000\n";
    for (int i = 1; i <= 1000; ++i) text += std::to_string(i) + " 0 0 0\n";
    text += "$EndNodes\n$NodeData\n1\n\"a\"\n0\n3\n0 1000000 0\n$EndNodeData\n";
    EXPECT_NE(refusal(text, Format::msh).reason().find("too few"), std::string::npos);
}

// --- VTU ---

std::string vtu(const std::string& attributes, const std::string& points, const std::string& more,
                const std::string& tail = "") {
    return "<?xml version='1.0'?>\n<!-- a > b -->\n<VTKFile type='UnstructuredGrid' " + attributes +
           ">\n<UnstructuredGrid><FieldData><DataArray type='String' Name='s' "
           "format='ascii'>65</DataArray></FieldData>\n"
           "<Piece NumberOfPoints='5' NumberOfCells='6'>\n<Points>" +
           points +
           "</Points>\n<Cells><DataArray type='Int64' Name='connectivity' format='ascii'>0 1 2 3 0 1 2 0 1 3 2 0 1 2 3 "
           "4 0 1 2 4</DataArray>"
           "<DataArray type='UInt32' Name='offsets' format='ascii'>4 7 11 16 19 20</DataArray>"
           "<DataArray type='UInt8' Name='types' format='ascii'>10 5 8 6 4 1</DataArray></Cells>\n" +
           more + "</Piece></UnstructuredGrid>" + tail + "</VTKFile>\n";
}

const char* const text_points =
    "<DataArray type='Float32' NumberOfComponents='3' format='ascii'>0 0 0 1 0 0 0 1 0 0 0 1 1 1 1"
    "<InformationKey name='L2_NORM_RANGE'><Value index='0'>0</Value></InformationKey></DataArray>";

TEST(Vtu, ReadsPixelsStripsPolylinesAndSplitsCellArrays) {
    const MeshDocument document =
        parse_document(vtu("version='0.1'", text_points,
                           "<CellData><DataArray type='Int32' Name='marker' format='ascii'>1 2 3 4 5 6</DataArray>"
                           "<DataArray type='Float64' Name='q' NumberOfComponents='2' format='ascii'>0 0 1 2 3 4 5 6 0 "
                           "0 7 8</DataArray>"
                           "<DataArray type='Int8' Name='region' format='ascii'>9 0 0 0 0 0</DataArray></CellData>"),
                       Format::vtu);
    EXPECT_EQ(polygons_of(document), (Lists{{0, 1, 2}, {0, 1, 2, 3}, {0, 1, 2}, {2, 1, 3}, {2, 3, 4}}));
    EXPECT_EQ(segments_of(document), (Lists{{0, 1}, {1, 2}}));
    EXPECT_EQ(document.tetrahedra.size(), 1U);
    EXPECT_EQ(document.complex.facet_markers, (std::vector<std::int32_t>{2, 3, 4, 4, 4}));
    EXPECT_EQ(document.complex.segment_markers, (std::vector<std::int32_t>{5, 5}));
    ASSERT_EQ(document.fields.size(), 3U);  // marker and region of tetrahedra, q of polygons
    EXPECT_EQ(std::get<std::vector<double>>(document.fields[1].values),
              (std::vector<double>{1, 2, 3, 4, 5, 6, 5, 6, 5, 6}));
    EXPECT_EQ(document.notes.size(), 2U);  // FieldData, the vertex cell
}

/// Five points at (i, 0, 0) as little-endian doubles.
std::string point_bytes(bool big = false) {
    std::string bytes;
    for (int i = 0; i < 5; ++i)
        for (const double c : {static_cast<double>(i), 0.0, 0.0}) put(bytes, c, big);
    return bytes;
}

TEST(Vtu, ReadsRawAppendedDataOfBothByteOrdersAndHeaderTypes) {
    for (const bool big : {false, true})
        for (const bool wide : {false, true}) {
            std::string data = "skipped<&>";
            const std::size_t offset = data.size();
            wide ? put(data, std::uint64_t{120}, big) : put(data, std::uint32_t{120}, big);
            data += point_bytes(big);
            const MeshDocument document =
                parse_document(vtu(std::string("byte_order='") + (big ? "BigEndian" : "LittleEndian") +
                                       (wide ? "' header_type='UInt64'" : "'"),
                                   "<DataArray type='Float64' NumberOfComponents='3' format='appended' offset='" +
                                       std::to_string(offset) + "'/>",
                                   "", "<AppendedData encoding='raw'>\n   _" + data + "\n</AppendedData>"),
                               Format::vtu);
            ASSERT_EQ(document.complex.positions.size(), 5U);
            EXPECT_EQ(document.complex.positions[4], (Point3{4, 0, 0}));
        }
}

TEST(Vtu, ReadsCompressedAndBase64AppendedData) {
    // Packed by an independent zlib: one block with fixed codes, one stored block, two blocks; then not packed.
    const std::string fixed = "AQAAAHgAAAAAAAAAGQAAAA==eNpjYMAHPtjjkHDALsyBQ1wAQxwAi+8CCA==";
    const std::string stored =
        "AQAAAHgAAAAAAAAAgwAAAA==eAEBeACH/wAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAPA/AAAAAAAAAAAAAAAAAAAAAAAA"
        "AAAAAABAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAhAAAAAAAAAAAAAAAAAAAAAAAAAAAAAABBAAAAAAAAAAAAAAAAAAAAAAIvvAgg=";
    const std::string two = "AgAAAEAAAAA4AAAAEgAAABQAAAA=eNpjYMAHPtjjkHCAMQAqfwFweAFjYEAGHA7IPARbAEMcABEoAJk=";
    const std::string plain =
        "eAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAPA/AAAAAAAAAAAAAAAAAAAAAAAAAAAAAABAAAAAAAAAAAAAAAAAAAAA"
        "AAAAAAAAAAhAAAAAAAAAAAAAAAAAAAAAAAAAAAAAABBAAAAAAAAAAAAAAAAAAAAAAA==";
    for (const std::string& data : {fixed, stored, two, plain}) {
        const std::string compressor = data == plain ? "" : "compressor='vtkZLibDataCompressor'";
        const auto expect_points = [](const std::string& text) {
            const MeshDocument document = parse_document(text, Format::vtu);
            ASSERT_EQ(document.complex.positions.size(), 5U);
            for (int i = 0; i < 5; ++i)
                EXPECT_EQ(document.complex.positions[i], (Point3{static_cast<double>(i), 0, 0}));
        };
        const std::string array = "<DataArray type='Float64' NumberOfComponents='3' format=";
        expect_points(vtu(compressor, array + "'binary'>\n  " + data + "\n</DataArray>", ""));
        expect_points(vtu(compressor, array + "'appended' offset='4'/>", "",
                          "<AppendedData encoding='base64'>_AAAA" + data + "AAAA</AppendedData>"));
        // Damage is noticed: every byte is under the checksum.
        if (data == plain) continue;
        std::string damaged = data;
        damaged[data.find("==") == std::string::npos ? 50 : 40] ^= 1;
        EXPECT_THROW(parse_document(vtu(compressor, array + "'binary'>" + damaged + "</DataArray>", ""), Format::vtu),
                     IoError);
    }
}

TEST(Inflate, ReadsDynamicCodes) {
    const std::string packed =
        "eNqN1EmOhDAQRFHwmB4zPZu6/0G7F7CykDlCvC/FoWVueB4hh37EQlxUfvioMTB1ADTWtO7icF44KB17s9Ek0k4R6WBKCyVJfYIq"
        "ndgZSxwn1iRkE2dAoMj1acwQw5ipWIgq2DbTHB5tTuB1ShBt7bFmBczoOhJnWHHy1IvSQ3FMNpM03Lkpp7WX5hF1dP3K1wzkSjYB"
        "cjbo+qRewQpn+lWkSD39RB5Vw9SCsitJWeH9pS7nfiCQAO85AQiVlYjKQ64+k1DHi8k9p/MOMOTpg/SmDhrdvZnccxi1LFWXLJJJ"
        "KIBZ+2Zyz2kDW9GGW2gzC06NrjeTe44fv/K7YvK1/CcqxZJ/M9kmXky2iReTbeLFZJt4MdkmXky2iReTbeLFZJt4MdkmXky2iReT"
        "beLFZJt4MdkmXky2iReTbeLF5PuzPSbfn+0x+f5sj8n3Z3tMvj/bY/IHp6VMIQ==";
    std::string expected;
    for (int i = 0; i < 1500; ++i) expected += static_cast<char>((i * i * 7 + i / 3) % 23 + (i / 50) % 5);
    const std::string stream = io::decode_base64(packed, packed.size()).value();
    EXPECT_EQ(io::inflate_zlib(stream, expected.size()), expected);
    EXPECT_FALSE(io::inflate_zlib(stream, expected.size() - 1));
    EXPECT_FALSE(io::inflate_zlib(stream, expected.size() + 1));
    for (std::size_t i = 0; i < stream.size(); ++i) {
        EXPECT_FALSE(io::inflate_zlib(stream.substr(0, i), expected.size()));
        for (int bit = 0; bit < 8; ++bit) {
            std::string damaged = stream;
            damaged[i] = static_cast<char>(damaged[i] ^ 1 << bit);
            const auto bytes = io::inflate_zlib(damaged, expected.size());
            // The level of compression is a remark in the header that changes nothing.
            if (bytes) {
                EXPECT_EQ(*bytes, expected);
            }
        }
    }
}

}  // namespace
}  // namespace certa::test
