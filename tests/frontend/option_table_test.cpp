// The option tables keep their promises: every default is inside its bounds, every value survives the way through text,
// what is out of range or ill-formed is refused by name.
#include "frontend/option_table.h"

#include <gtest/gtest.h>

#include <set>

namespace {

using namespace certa;
using namespace certa::frontend;

const Option<ConformOptions>& option_named(std::string_view name) {
    for (const auto& option : conform_options())
        if (option.name == name) return option;
    throw std::logic_error("no such option");
}

void expect_refused(std::string_view name, std::string_view text) {
    ConformOptions options;
    try {
        set_option(option_named(name), options, text);
        ADD_FAILURE() << name << " accepted " << text;
    } catch (const OptionError& error) {
        EXPECT_EQ(std::string(error.what()).find("--"), 0U) << error.what();
    }
}

TEST(OptionTable, NamesAreUniqueAndDefaultsSurviveTheWayThroughText) {
    std::set<std::string_view> names, flags;
    for (const auto& option : conform_options()) {
        EXPECT_TRUE(names.insert(option.name).second);
        EXPECT_TRUE(flags.insert(option.flag).second);
        const std::string text = value_of(option, ConformOptions{});
        if (text.empty() || text == "off") continue;
        ConformOptions options;
        ASSERT_NO_THROW(set_option(option, options, text)) << option.name;
        EXPECT_EQ(value_of(option, options), text);
    }
}

TEST(OptionTable, EveryMemberOfConformOptionsIsReachable) {
    ConformOptions options;
    for (const auto& [name, text] :
         std::initializer_list<std::pair<std::string_view, std::string_view>>{{"protection", "all"},
                                                                              {"gabriel", ""},
                                                                              {"alpha", "0.25"},
                                                                              {"merge_coplanar", ""},
                                                                              {"triangulate", ""},
                                                                              {"repair", ""},
                                                                              {"keep_outside", ""},
                                                                              {"planarity", "0.5"},
                                                                              {"min_feature", "2%"},
                                                                              {"max_points", "77"}})
        set_option(option_named(name), options, text);
    EXPECT_EQ(options.protection, Protection::all);
    EXPECT_TRUE(options.gabriel && options.merge_coplanar && options.triangulate && options.repair);
    EXPECT_TRUE(options.keep_outside);
    EXPECT_EQ(options.alpha, 0.25);
    EXPECT_EQ(options.planarity.value, 0.5);
    EXPECT_FALSE(options.planarity.relative_to_diagonal);
    EXPECT_EQ(options.min_feature.resolve(50.0), 1.0);
    EXPECT_EQ(options.max_points, 77U);
}

TEST(OptionTable, OutOfRangeAndIllFormedAreRefused) {
    for (const char* text : {"0", "0.5", "-0.1", "nan", "inf", "0,4", "0.4 ", "", "1e999", "0.4x", "+0.4"})
        expect_refused("alpha", text);
    for (const char* text : {"-1", "-1%", "%", "2 %", "2%%", "inf", "one"}) expect_refused("planarity", text);
    for (const char* text : {"0", "-3", "1.5", "1e6", "99999999999999999999"}) expect_refused("max_points", text);
    for (const char* text : {"", "None", "NEEDED", "sharp "}) expect_refused("protection", text);
    expect_refused("gabriel", "yes");
}

TEST(OptionTable, HelpShowsDefaultsAndBounds) {
    EXPECT_NE(help_of(option_named("alpha")).find("(0, 0.5); default 0.4"), std::string::npos);
    EXPECT_NE(help_of(option_named("max_points")).find("at least 1; no limit"), std::string::npos);
    EXPECT_EQ(value_name_of(option_named("protection")), "needed|sharp|all");
    EXPECT_EQ(value_name_of(option_named("gabriel")), "");
}

}  // namespace
