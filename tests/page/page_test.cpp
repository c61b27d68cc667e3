// Pages from memory: what is refused and how it is named, and that nothing about a page depends on anything but its
// models. What is embedded is read back by page_data_test.py.
#include <certa/error.h>
#include <certa/view.h>
#include <gtest/gtest.h>

#include <array>
#include <limits>

#include "page/json_text.h"
#include "page/shield_edges.h"
#include "page/template.h"

namespace {

using namespace certa;

ViewModel make_tetrahedron() {
    ViewModel model;
    model.name = "tetrahedron";
    MeshDocument& document = model.document;
    document.complex.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    const auto v = [](std::uint32_t i) { return VertexId{i}; };
    for (const auto& [a, b, c] : {std::array{0U, 2U, 1U}, {0U, 1U, 3U}, {1U, 2U, 3U}, {0U, 3U, 2U}})
        add_facet(document.complex, {{v(a), v(b), v(c)}});
    document.complex.segments = {{v(0), v(3)}};
    document.tetrahedra = {{v(0), v(1), v(2), v(3)}};
    document.fields = {{"mean", Location::vertices, 1, std::vector<double>{1, 2, 3, 4}}};
    return model;
}

Defect refusal_of(const ViewModel& model) {
    try {
        format_view(std::array{model});
    } catch (const InputError& error) {
        EXPECT_EQ(error.defects().size(), 1U);
        return error.defects().front();
    }
    ADD_FAILURE() << "a page was made";
    return {};
}

TEST(FormatView, SameModelsSameBytes) {
    const std::array models{make_tetrahedron(), make_tetrahedron()};
    const std::string page = format_view(models);
    EXPECT_EQ(page, format_view(models));
    EXPECT_EQ(page.find(page::data_place), std::string::npos);
    EXPECT_NE(page, format_view(models, {.title = "two"}));
}

TEST(FormatView, TheTemplateKeepsOnePlaceForTheData) {
    const std::string_view text = page::page_template();
    const std::size_t place = text.find(page::data_place);
    ASSERT_NE(place, std::string_view::npos);
    EXPECT_EQ(text.find(page::data_place, place + 1), std::string_view::npos);
    EXPECT_NE(text.find("The MIT License"), std::string_view::npos);
    for (const std::string_view fetched : {"src=\"http", "href=\"http", "@import", "//cdn"})
        EXPECT_EQ(text.find(fetched), std::string_view::npos) << fetched;
}

TEST(FormatView, NothingToShowIsRefused) {
    EXPECT_THROW(format_view({}), InputError);
    ViewModel model;
    model.name = "hollow.off";
    const Defect defect = refusal_of(model);
    EXPECT_EQ(defect.kind, DefectKind::empty_input);
    EXPECT_NE(defect.message.find("hollow.off"), std::string::npos);
}

TEST(FormatView, WhatWouldReadBeyondAnArrayIsRefusedByElement) {
    ViewModel model = make_tetrahedron();
    model.document.complex.corners[4] = VertexId{4};
    Defect defect = refusal_of(model);
    EXPECT_EQ(defect.kind, DefectKind::index_out_of_range);
    EXPECT_EQ(defect.elements, (std::vector<ElementRef>{{ElementKind::polygon, 1}}));
    EXPECT_NE(defect.message.find("polygon 2 names vertex 5 of 4"), std::string::npos) << defect.message;

    model = make_tetrahedron();
    model.document.tetrahedra[0][3] = VertexId{no_index};
    defect = refusal_of(model);
    EXPECT_EQ(defect.elements.front(), (ElementRef{ElementKind::tetrahedron, 0}));

    model = make_tetrahedron();
    model.document.complex.segments[0][1] = VertexId{7};
    EXPECT_EQ(refusal_of(model).elements.front(), (ElementRef{ElementKind::segment, 0}));

    model = make_tetrahedron();
    model.document.complex.positions[2].y = std::numeric_limits<double>::infinity();
    defect = refusal_of(model);
    EXPECT_EQ(defect.kind, DefectKind::non_finite_coordinate);
    EXPECT_EQ(defect.elements, (std::vector<ElementRef>{{ElementKind::vertex, 2}}));
}

TEST(FormatView, ArraysThatDoNotFitAreRefused) {
    ViewModel model = make_tetrahedron();
    model.document.fields[0].values = std::vector<double>{1, 2, 3};
    EXPECT_NE(refusal_of(model).message.find("'mean' has 3 numbers instead of 4"), std::string::npos);
    model.document.fields[0].components = 0;
    refusal_of(model);
    model = make_tetrahedron();
    model.document.complex.facet_markers = {1, 2};
    refusal_of(model);
    model = make_tetrahedron();
    model.document.complex.facet_offsets.back() = 9;
    refusal_of(model);
    model = make_tetrahedron();
    model.document.complex.polygon_offsets[1] = 99;
    refusal_of(model);
}

TEST(FormatView, FieldsMayHaveGaps) {
    ViewModel model = make_tetrahedron();
    const double nan = std::numeric_limits<double>::quiet_NaN();
    model.document.fields[0].values = std::vector<double>{nan, 2, 3, nan};
    const std::string page = format_view(std::array{model});
    EXPECT_NE(page.find("\"min\":2,\"max\":3"), std::string::npos);
}

TEST(JsonText, StringsAreSafeInHtmlAndAlwaysUtf8) {
    EXPECT_EQ(page::json_string("a</script>\"\\\n"), "\"a\\u003c/script\\u003e\\\"\\\\\\u000a\"");
    EXPECT_EQ(page::json_string("\xC3\xA9 \xE2\x82\xAC \xF0\x9F\x90\xB0"),
              "\"\xC3\xA9 \xE2\x82\xAC \xF0\x9F\x90\xB0\"");
    // A lone continuation byte, an overlong slash, a surrogate, a sequence cut short, beyond U+10FFFF.
    for (const char* bad : {"\x80", "\xC0", "\xE2\x82", "\xF5"})
        EXPECT_EQ(page::json_string(bad).substr(0, 7), "\"\\ufffd") << bad;
    EXPECT_EQ(page::json_string("\xED\xA0\x80"), "\"\\ufffd\\ufffd\\ufffd\"");
    EXPECT_EQ(page::json_number(0.1), "0.1");
    EXPECT_EQ(page::json_number(5e-324), "5e-324");
}

/// A facet with one protected corner: its isosceles triangle, a right-angled one, and one that only shares the corner.
TEST(ShieldEdges, AreOppositeTheCentresOfBalls) {
    MeshDocument document;
    document.complex.positions = {{0, 0, 0}, {2, 0, 0}, {0, 2, 0}, {1, 0, 0}, {3, 3, 0}, {-2, 0, 0}};
    const auto v = [](std::uint32_t i) { return VertexId{i}; };
    for (const auto& [a, b, c] : {std::array{0U, 1U, 2U}, {3U, 2U, 0U}, {1U, 4U, 2U}, {0U, 2U, 5U}, {2U, 1U, 0U}})
        add_facet(document.complex, {{v(a), v(b), v(c)}});
    EXPECT_TRUE(page::find_shield_edges(document).empty());
    document.fields = {{"ball_radius", Location::vertices, 1, std::vector<double>{2, 0, 0, 0, 0, 0}}};
    EXPECT_EQ(page::find_shield_edges(document), (std::vector<std::uint32_t>{1, 2, 2, 5}));
    document.fields = {{"ball_radius", Location::vertices, 1, std::vector<double>{1.999, 0, 0, 0, 0, 0}}};
    EXPECT_TRUE(page::find_shield_edges(document).empty());
}

TEST(FormatView, OverlaysSaySo) {
    ViewModel model = make_tetrahedron();
    EXPECT_EQ(format_view(std::array{model}).find("\"overlay\""), std::string::npos);
    model.is_overlay = true;
    EXPECT_NE(format_view(std::array{model}).find("\"overlay\":true"), std::string::npos);
}

}  // namespace
