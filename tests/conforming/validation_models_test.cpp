// The validator on real models: those whose index entry says that they are sound pass, those that intersect themselves
// are refused for it. The index was made by another tool on merged vertices; the exceptions below were looked at one by
// one.
#include <certa/io.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <set>
#include <sstream>

#include "validation_support.h"

namespace certa::test {
namespace {

struct Entry {
    std::string file;
    long pairs = 0;         ///< self-intersecting pairs of faces
    bool flawless = false;  ///< no degenerate, duplicate or bad faces, no duplicate vertices
    bool triangles = false;
};

/// The entries with a count of self-intersecting pairs; surfaces only.
std::vector<Entry> read_index(const std::filesystem::path& path) {
    std::ifstream in(path);
    std::vector<Entry> entries;
    std::string line;
    std::getline(in, line);
    while (std::getline(in, line)) {
        std::vector<std::string> columns;
        std::stringstream fields(line);
        for (std::string field; std::getline(fields, field, '\t');) columns.push_back(field);
        if (columns.size() < 12 || columns[7].empty()) continue;
        if (columns[7].find_first_not_of("0123456789") != std::string::npos) continue;
        const std::string& notes = columns[11];
        const bool sound = notes.starts_with("dupv=0;dupf=0;") && notes.find("badfaces=0") != std::string::npos;
        const bool triangles = columns[4].starts_with("3:") && columns[4].find(',') == std::string::npos;
        entries.push_back({columns[0], std::atol(columns[7].c_str()), sound && columns[10] == "0", triangles});
    }
    return entries;
}

std::map<DefectKind, long> count_kinds(const std::vector<Defect>& defects) {
    std::map<DefectKind, long> counts;
    for (const Defect& defect : defects) ++counts[defect.kind];
    return counts;
}

/// Facets that touch in more than the index's tool asks for, or in less, all looked at: T-junctions, sides that cross
/// without their facets crossing, sides that lie in facets. Its pairs count each of them once per pair of faces.
const std::set<std::string> counted_otherwise{"cad/angle_block.STL", "cad/featuretype.STL", "cad/octagonal_pocket.ply"};

/// Coplanar facets that overlap, and triangles that coincide up to 1e-33.
const std::set<std::string> beyond_repair{"defects/not_convex.obj", "cad/octagonal_pocket.ply"};

void check_sound(const Entry& entry, const PiecewiseLinearComplex& complex) {
    const auto report = report_of(complex);
    if (entry.triangles) {
        EXPECT_TRUE(report.ok()) << entry.file << ": " << report.defects[0].message;
        return;
    }
    // Polygons in files are rarely planar in doubles; cut into triangles they are sound.
    for (const Defect& d : report.defects) EXPECT_EQ(d.kind, DefectKind::non_planar_facet) << entry.file << d.message;
    if (entry.file == "defects/polygonfaces.obj") return;  // crosses itself when laid flat
    const auto cut = repair_complex(complex, {.triangulate = true});
    const auto again = report_of(cut.complex);
    EXPECT_TRUE(again.ok()) << entry.file << " triangulated: " << again.defects[0].message;
}

void check_intersecting(const Entry& entry, const PiecewiseLinearComplex& complex) {
    const auto report = report_of(complex);
    EXPECT_FALSE(report.ok()) << entry.file;
    auto counts = count_kinds(report.defects);
    const long crossing = counts[DefectKind::crossing_facets] + counts[DefectKind::overlapping_facets];
    const long touching = counts[DefectKind::crossing_segments] + counts[DefectKind::point_on_segment] +
                          counts[DefectKind::repeated_facet] + counts[DefectKind::degenerate_facet];
    EXPECT_GT(crossing + touching, 0) << entry.file;
    const ConformOptions options{.triangulate = true, .repair = true};
    const auto after = report_of(repair_complex(complex, options).complex, options);
    if (!beyond_repair.contains(entry.file)) {
        EXPECT_TRUE(after.ok()) << entry.file << " repaired: " << after.defects[0].message;
    }
    if (entry.flawless && entry.triangles && !counted_otherwise.contains(entry.file)) {
        EXPECT_EQ(crossing, entry.pairs) << entry.file;
    }
}

TEST(Models, AgreeWithTheIndex) {
    const char* folder = std::getenv("CERTA_MODELS");
    const std::filesystem::path root = folder != nullptr ? folder : "";
    if (folder == nullptr || !std::filesystem::exists(root / "INDEX.tsv")) GTEST_SKIP() << "needs CERTA_MODELS";
    int sound = 0, intersecting = 0;
    for (const Entry& entry : read_index(root / "INDEX.tsv")) {
        if (entry.file == "defects/gen_denormal_coords.off") continue;  // all of it within 1e-309: out of range
        const PiecewiseLinearComplex complex = read_document((root / entry.file).string()).complex;
        if (entry.pairs == 0 && entry.flawless) {
            check_sound(entry, complex);
            ++sound;
        } else if (entry.pairs > 0) {
            check_intersecting(entry, complex);
            ++intersecting;
        }
    }
    EXPECT_GT(sound, 80);
    EXPECT_GT(intersecting, 20);
}

/// Piecewise linear complexes (.poly, .smesh and polygon files), valid by their makers' word.
TEST(Models, ComplexesAreValid) {
    const char* folder = std::getenv("CERTA_MODELS");
    const std::filesystem::path root = folder != nullptr ? folder : "";
    if (folder == nullptr || !std::filesystem::exists(root / "plc_eco")) GTEST_SKIP() << "needs CERTA_MODELS";
    int count = 0;
    for (const auto& file : std::filesystem::directory_iterator(root / "plc_eco")) {
        const std::string name = file.path().filename().string();
        if (name == "ALSTOM_TEST4.off") continue;  // 44 pairs of its faces cross
        if (name.ends_with(".md") || name.ends_with(".txt")) continue;
        const auto report = report_of(read_document(file.path().string()).complex);
        EXPECT_TRUE(report.ok()) << name << ": " << report.defects[0].message;
        ++count;
    }
    EXPECT_GT(count, 20);
}

}  // namespace
}  // namespace certa::test
