// What is written reads back to the bit: for every format, a document of everything that it can carry, with hostile
// numbers (signed zero, denormals, 1e308) and random ones of all exponents.
#include <clocale>

#include "documents.h"

namespace certa::test {
namespace {

void expect_round_trip(const MeshDocument& document, Format format, const WriteOptions& options = {}) {
    SCOPED_TRACE(name_of(format));
    std::string text;
    ASSERT_NO_THROW(text = format_document(document, format, options));
    MeshDocument back;
    try {
        back = parse_document(text, format, "written");
    } catch (const std::exception& error) {
        FAIL() << error.what() << "\n" << text.substr(0, 2000);
    }
    expect_same(document, back);
    // Writing is deterministic, and the second generation equals the first.
    EXPECT_EQ(format_document(back, format, options), text);
}

class RoundTrip : public testing::TestWithParam<int> {
protected:
    std::mt19937_64 random{static_cast<std::uint64_t>(GetParam())};
    MeshDocument surface(std::size_t least, std::size_t most) {
        MeshDocument document;
        add_points(document, 7 + random() % 20, random);
        for (std::size_t i = random() % 15; i > 0; --i)
            add_polygon(document, least + random() % (most - least + 1), random);
        return document;
    }
};

TEST_P(RoundTrip, Off) {
    MeshDocument document = surface(1, 9);
    expect_round_trip(document, Format::off);
}

TEST_P(RoundTrip, Obj) {
    MeshDocument document = surface(1, 9);
    add_segments(document, random() % 9, random);
    expect_round_trip(document, Format::obj);
}

MeshDocument with_ply_fields(MeshDocument document, std::mt19937_64& random) {
    PiecewiseLinearComplex& complex = document.complex;
    const std::size_t points = complex.positions.size(), polygons = complex.polygon_count();
    complex.point_markers = random_markers(points, random);
    document.fields.push_back(random_field("mean", Location::vertices, points, 1, random));
    document.fields.push_back(random_field("normal", Location::vertices, points, 3, random));
    document.fields.push_back(random_field("dir_min", Location::vertices, points, 3, random));
    document.fields.push_back(random_field("tensor", Location::vertices, points, 6, random));
    document.fields.push_back(integer_field("big", Location::vertices, std::vector<std::int64_t>(points, 4294967295)));
    document.fields.push_back(
        integer_field("small", Location::vertices, std::vector<std::int64_t>(points, -2147483648LL)));
    if (polygons > 0) {
        complex.facet_markers = random_markers(polygons, random);
        document.fields.push_back(random_field("area", Location::polygons, polygons, 1, random));
    }
    if (!complex.segments.empty()) {
        complex.segment_markers = random_markers(complex.segments.size(), random);
        document.fields.push_back(random_field("length", Location::segments, complex.segments.size(), 2, random));
    }
    return document;
}

TEST_P(RoundTrip, Ply) {
    MeshDocument document = surface(1, 9);
    add_segments(document, random() % 5, random);
    document = with_ply_fields(std::move(document), random);
    expect_round_trip(document, Format::ply, {.encoding = Encoding::ascii});
    expect_round_trip(document, Format::ply, {.encoding = Encoding::binary});
    expect_round_trip(document, Format::ply);
}

TEST_P(RoundTrip, PlyWithPolygonsBeyondOneByte) {
    MeshDocument document = surface(250, 400);
    expect_round_trip(document, Format::ply, {.encoding = Encoding::ascii});
    expect_round_trip(document, Format::ply);
}

TEST_P(RoundTrip, PolyAndSmesh) {
    MeshDocument document = surface(3, 9);
    add_segments(document, random() % 5, random);
    PiecewiseLinearComplex& complex = document.complex;
    complex.point_markers = random_markers(complex.positions.size(), random);
    if (complex.facet_count() > 0) complex.facet_markers = random_markers(complex.facet_count(), random);
    if (!complex.segments.empty()) complex.segment_markers = random_markers(complex.segments.size(), random);
    complex.region_holes = {{1e308, -0.0, 5e-324}};
    complex.region_seeds = {{{0.1, 0.2, 0.3}, -7.25, 1e-300}, {{1, 2, 3}, 0, 0}};
    document.fields.push_back(random_field("attribute", Location::vertices, complex.positions.size(), 2, random));
    expect_round_trip(document, Format::smesh);
    const Point3 hole = complex.positions[0];
    const auto v = [&] { return random_vertex(document, random); };
    add_facet(complex, {{v(), v(), v(), v()}, {v(), v()}, {v()}, {v(), v(), v()}}, {hole, {0.5, 0.25, -0.0}});
    add_facet(complex, {{v(), v()}}, {hole});  // with a hole it is no segment
    add_facet(complex, {{v()}});
    complex.facet_markers = random_markers(complex.facet_count(), random);
    expect_round_trip(document, Format::poly);
}

MeshDocument volume(std::mt19937_64& random) {
    MeshDocument document;
    add_points(document, 7 + random() % 20, random);
    for (std::size_t i = random() % 9; i > 0; --i) add_polygon(document, 3, random);
    add_segments(document, random() % 9, random);
    add_tetrahedra(document, random() % 9, random);
    return document;
}

void add_all_markers(MeshDocument& document, std::mt19937_64& random) {
    PiecewiseLinearComplex& complex = document.complex;
    complex.point_markers = random_markers(complex.positions.size(), random);
    if (complex.facet_count() > 0) complex.facet_markers = random_markers(complex.facet_count(), random);
    if (!complex.segments.empty()) complex.segment_markers = random_markers(complex.segments.size(), random);
    std::vector<std::int64_t> markers(document.tetrahedra.size());
    for (std::int64_t& marker : markers) marker = 1 + static_cast<std::int64_t>(random() % 1000);
    if (!markers.empty()) document.fields.push_back(integer_field("marker", Location::tetrahedra, std::move(markers)));
}

TEST_P(RoundTrip, Medit) {
    MeshDocument document = volume(random);
    for (int i = 0; i < 3; ++i) add_polygon(document, 4, random);
    expect_round_trip(document, Format::medit);
    add_all_markers(document, random);
    expect_round_trip(document, Format::medit);
}

TEST_P(RoundTrip, Vtu) {
    MeshDocument document = volume(random);
    for (int i = 0; i < 3; ++i) add_polygon(document, 3 + random() % 5, random);
    expect_round_trip(document, Format::vtu);
    document = with_ply_fields(std::move(document), random);
    const std::int64_t most = std::numeric_limits<std::int64_t>::max();
    document.fields.push_back(integer_field("wide <&\"'> name", Location::vertices,
                                            std::vector<std::int64_t>(document.complex.positions.size(), most)));
    document.fields.push_back(random_field("shared", Location::polygons, document.complex.polygon_count(), 4, random));
    if (!document.tetrahedra.empty())
        document.fields.push_back(random_field("shared", Location::tetrahedra, document.tetrahedra.size(), 4, random));
    for (const Encoding encoding : {Encoding::automatic, Encoding::ascii, Encoding::binary})
        expect_round_trip(document, Format::vtu, {.encoding = encoding});
}

TEST_P(RoundTrip, Msh) {
    MeshDocument document = volume(random);
    for (int i = 0; i < 6; ++i) add_polygon(document, 3 + random() % 2, random);
    for (const int step : {0, 1, 2}) {
        if (step == 1) {
            // Positive markers travel as tags.
            document.complex.facet_markers.assign(document.complex.facet_count(), 0);
            for (std::int32_t& marker : document.complex.facet_markers)
                marker = static_cast<std::int32_t>(random() % 4);
            document.complex.facet_markers[0] = 2147483646;
            if (!document.complex.segments.empty())
                document.complex.segment_markers.assign(document.complex.segments.size(), 3);
        }
        if (step == 2) {
            add_all_markers(document, random);
            const std::size_t points = document.complex.positions.size(), polygons = document.complex.polygon_count();
            document.fields.push_back(random_field("a name", Location::vertices, points, 1, random));
            document.fields.push_back(random_field("normal", Location::vertices, points, 3, random));
            document.fields.push_back(random_field("tensor", Location::polygons, polygons, 9, random));
            std::vector<std::int64_t> facets(polygons);
            for (std::int64_t& facet : facets) facet = 1 + static_cast<std::int64_t>(random() % 3);
            document.fields.push_back(integer_field("facet", Location::polygons, facets));
            // Tags take one number per element: with both there, the caller chooses.
            document.reference = random() % 2 == 0 ? Reference::id : Reference::marker;
        }
        for (const bool version_2 : {false, true})
            for (const Encoding encoding : {Encoding::automatic, Encoding::ascii, Encoding::binary}) {
                const WriteOptions options{.encoding = encoding, .msh_version_2 = version_2};
                const std::string text = format_document(document, Format::msh, options);
                expect_same(document, parse_document(text, Format::msh, "written"));
            }
    }
}

TEST_P(RoundTrip, StlKeepsTriangles) {
    MeshDocument document;
    add_points(document, 12, random);
    for (int i = 0; i < 20; ++i) add_polygon(document, 3, random);
    // STL has no vertices of its own: use each, then compare corner by corner.
    for (std::uint32_t i = 0; i < 12; i += 3)
        add_facet(document.complex, {{VertexId{i}, VertexId{i + 1}, VertexId{i + 2}}});
    const MeshDocument back = parse_document(format_document(document, Format::stl), Format::stl);
    ASSERT_EQ(back.complex.corners.size(), document.complex.corners.size());
    for (std::size_t i = 0; i < back.complex.corners.size(); ++i) {
        const Point3& a = document.complex.positions[index_of(document.complex.corners[i])];
        const Point3& b = back.complex.positions[index_of(back.complex.corners[i])];
        EXPECT_TRUE(a == b) << i;
    }
}

INSTANTIATE_TEST_SUITE_P(Seeds, RoundTrip, testing::Range(1, 41));

TEST(StlRoundTrip, IsBinaryWhereThatLosesNothing) {
    MeshDocument document;
    document.complex.positions = {{0.5, -0.25, 3}, {1, 0, 1.5}, {2, 7, -1}};
    add_facet(document.complex, {{VertexId{0}, VertexId{1}, VertexId{2}}});
    const std::string binary = format_document(document, Format::stl);
    EXPECT_EQ(binary.size(), 84U + 50U);
    expect_same(document, parse_document(binary, Format::stl));
    expect_same(document,
                parse_document(format_document(document, Format::stl, {.encoding = Encoding::ascii}), Format::stl));
    document.complex.positions[0].x = 0.1;
    EXPECT_TRUE(format_document(document, Format::stl).starts_with("solid"));
    expect_same(document, parse_document(format_document(document, Format::stl), Format::stl));
    EXPECT_THROW(format_document(document, Format::stl, {.encoding = Encoding::binary}), IoError);
}

TEST(EmptyRoundTrip, EveryFormatWritesNothingAndReadsItBack) {
    for (const Format format :
         {Format::off, Format::obj, Format::ply, Format::stl, Format::node, Format::medit, Format::vtu, Format::msh})
        expect_round_trip({}, format);
}

TEST(EmptyRoundTrip, PointsAlone) {
    std::mt19937_64 random(1);
    MeshDocument document;
    add_points(document, 30, random);
    for (const Format format : {Format::off, Format::obj, Format::ply, Format::poly, Format::smesh, Format::node,
                                Format::medit, Format::vtu, Format::msh})
        expect_round_trip(document, format);
    expect_round_trip(document, Format::msh, {.encoding = Encoding::binary});
}

TEST(Csv, HasAHeaderAndVectorsByComponent) {
    MeshDocument document;
    document.complex.positions = {{0, 0, 0}, {1, 0, 0}};
    document.complex.point_markers = {3, -4};
    document.fields.push_back({"k_min", Location::vertices, 1, std::vector<double>{0.1, -5e-324}});
    document.fields.push_back({"dir, min", Location::vertices, 3, std::vector<double>{1, 2, 3, -0.0, 1e308, 0.5}});
    document.fields.push_back(integer_field("ring", Location::vertices, {7, 8}));
    EXPECT_EQ(format_document(document, Format::csv),
              "marker,k_min,\"dir, min_x\",\"dir, min_y\",\"dir, min_z\",ring\n"
              "3,0.1,1,2,3,7\n"
              "-4,-5e-324,-0,1e+308,0.5,8\n");
    EXPECT_THROW(parse_document("a,b\n1,2\n", Format::csv), IoError);
}

TEST(Locale, DecimalCommasChangeNothing) {
    std::mt19937_64 random(2);
    MeshDocument document;
    add_points(document, 10, random);
    const std::string before = format_document(document, Format::off);
    bool any = false;
    for (const char* name : {"de_DE.UTF-8", "de_DE.utf8", "fr_FR.UTF-8", "C.UTF-8"}) {
        if (std::setlocale(LC_ALL, name) == nullptr) continue;
        any = true;
        EXPECT_EQ(format_document(document, Format::off), before);
        expect_same(document, parse_document(before, Format::off));
    }
    std::setlocale(LC_ALL, "C");
    EXPECT_TRUE(any);
}

}  // namespace
}  // namespace certa::test
