// Real files: every model of CERTA_MODELS is read, with the counts of its INDEX.tsv, or refused as expected, and comes
// back unchanged from every format that can carry it.
#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>

#include "documents.h"

namespace certa::test {
namespace {

namespace fs = std::filesystem;

/// Broken on purpose: the line of the refusal and a word of it.
const std::map<std::string, std::pair<std::uint64_t, std::string>> refused{
    {"defects/gen_empty_file.off", {1, "empty"}},
    {"defects/gen_index_out_of_range.off", {11, "out of range"}},
    {"defects/gen_inf_vertex.off", {6, "finite"}},
    {"defects/gen_nan_vertex.off", {6, "finite"}},
    {"defects/gen_negative_index.off", {11, "out of range"}},
    {"defects/gen_wrong_extension.stl", {1, "looks like off"}},
};

/// Counts that the index does not know (it was made by a reader that refused the file).
const std::map<std::string, std::pair<std::size_t, std::size_t>> corrected{
    {"defects/gen_obj_variants.obj", {4, 4}},
};

std::vector<std::string> cells_of(const std::string& line) {
    std::vector<std::string> cells;
    std::stringstream stream(line);
    for (std::string cell; std::getline(stream, cell, '\t');) cells.push_back(cell);
    return cells;
}

void expect_refusal(const std::string& folder, const std::string& name) {
    try {
        read_document(folder + "/" + name);
        FAIL() << name << " was read";
    } catch (const IoError& error) {
        EXPECT_EQ(error.line(), refused.at(name).first) << error.what();
        EXPECT_NE(error.reason().find(refused.at(name).second), std::string::npos) << error.what();
    }
}

void expect_round_trips(const MeshDocument& document, const std::string& name) {
    SCOPED_TRACE(name);
    const std::vector<std::uint32_t>& offsets = document.complex.polygon_offsets;
    const bool has_needle = std::adjacent_find(offsets.begin(), offsets.end(), [](std::uint32_t a, std::uint32_t b) {
                                return b - a == 2;
                            }) != offsets.end();
    for (const Format format : {Format::off, Format::obj, Format::ply, Format::poly, Format::smesh, Format::medit,
                                Format::vtu, Format::msh}) {
        // In TetGen's files a facet of two corners is a segment.
        if (has_needle && (format == Format::poly || format == Format::smesh)) continue;
        std::string text;
        try {
            text = format_document(document, format);
        } catch (const IoError& error) {
            EXPECT_NE(error.reason().find("cannot carry"), std::string::npos) << error.what();
            continue;
        }
        MeshDocument back = parse_document(text, format);
        back.notes = document.notes;
        expect_same(document, back);
    }
}

TEST(Models, AreReadAsTheIndexSays) {
    const char* folder = std::getenv("CERTA_MODELS");
    std::ifstream index(std::string(folder == nullptr ? "" : folder) + "/INDEX.tsv");
    if (folder == nullptr || !index) GTEST_SKIP() << "no INDEX.tsv in the folder CERTA_MODELS";
    std::string line;
    std::getline(index, line);
    int count = 0;
    while (std::getline(index, line)) {
        const std::vector<std::string> cells = cells_of(line);
        ASSERT_GE(cells.size(), 4U) << line;
        const std::string& name = cells[0];
        if (!fs::exists(std::string(folder) + "/" + name)) continue;
        ++count;
        if (refused.contains(name)) {
            expect_refusal(folder, name);
            continue;
        }
        MeshDocument document;
        ASSERT_NO_THROW(document = read_document(std::string(folder) + "/" + name)) << name;
        const PiecewiseLinearComplex& complex = document.complex;
        if (corrected.contains(name)) {
            EXPECT_EQ(std::pair(complex.positions.size(), complex.facet_count()), corrected.at(name)) << name;
        } else if (!cells[2].empty() && cells[2] != "-") {
            EXPECT_EQ(std::to_string(complex.positions.size()), cells[2]) << name;
            EXPECT_EQ(std::to_string(complex.facet_count()), cells[3]) << name;
        }
        if (cells.size() > 11 && cells[11].starts_with("tets=")) {
            EXPECT_EQ("tets=" + std::to_string(document.tetrahedra.size()), cells[11]) << name;
        }
        if (fs::file_size(std::string(folder) + "/" + name) < 400'000) expect_round_trips(document, name);
    }
    EXPECT_GT(count, 0);
}

}  // namespace
}  // namespace certa::test
