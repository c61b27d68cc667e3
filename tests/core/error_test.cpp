// The texts of errors are what a user sees first: they name the place and keep every defect as data.
#include <certa/error.h>
#include <certa/run_control.h>
#include <gtest/gtest.h>

#include <set>
#include <string>

#include "core/assert.h"

namespace {

using certa::Defect;
using certa::DefectKind;

TEST(Errors, IoErrorNamesPathAndLine) {
    const certa::IoError with_line("part.off", 12, "expected three numbers");
    EXPECT_STREQ(with_line.what(), "part.off:12: expected three numbers");
    EXPECT_EQ(with_line.line(), 12U);
    const certa::IoError without_line("part.stl", 0, "no such file");
    EXPECT_STREQ(without_line.what(), "part.stl: no such file");
}

TEST(Errors, InputErrorKeepsAllDefectsAndShowsTheFirst) {
    std::vector<Defect> defects(7, Defect{DefectKind::crossing_facets, {}, {}, "facets 1 and 2 cross"});
    defects[0] = Defect{DefectKind::duplicate_point, {}, {}, "vertices 3 and 9 coincide"};
    const certa::InputError error(defects);
    EXPECT_EQ(error.defects().size(), 7U);
    const std::string text = error.what();
    EXPECT_EQ(text.find("duplicate_point: vertices 3 and 9 coincide\ncrossing_facets: "), 0U);
    EXPECT_NE(text.find("\n... and 2 more"), std::string::npos);
}

// name_of must follow the order of the enumeration: one name each, none twice, none missing at the end.
TEST(Errors, EveryDefectKindHasItsOwnName) {
    std::set<std::string> names;
    const auto last = static_cast<int>(DefectKind::point_on_facet);
    for (int kind = 0; kind <= last; ++kind) names.insert(certa::name_of(static_cast<DefectKind>(kind)));
    EXPECT_EQ(names.size(), static_cast<std::size_t>(last) + 1);
    EXPECT_STREQ(certa::name_of(DefectKind::non_finite_coordinate), "non_finite_coordinate");
    EXPECT_STREQ(certa::name_of(DefectKind::hole_outside_facet), "hole_outside_facet");
    EXPECT_STREQ(certa::name_of(DefectKind::option_out_of_range), "option_out_of_range");
    EXPECT_STREQ(certa::name_of(DefectKind::point_on_facet), "point_on_facet");
    EXPECT_STREQ(certa::name_of(certa::ElementKind::option), "option");
    EXPECT_STREQ(certa::name_of(certa::Outcome::cancelled), "cancelled");
}

TEST(Errors, BrokenInvariantsAskForAReport) {
    try {
        CERTA_ASSERT(1 + 1 == 3);
        FAIL() << "the assertion passed";
    } catch (const certa::InternalError& error) {
        const std::string text = error.what();
        EXPECT_NE(text.find("1 + 1 == 3"), std::string::npos);
        EXPECT_NE(text.find("error_test.cpp:"), std::string::npos);
        EXPECT_NE(text.find("please report"), std::string::npos);
    }
}

}  // namespace
