// Every clean model at default options: what `remesh` promises, by the checker. Long.
#include <certa/curvature.h>
#include <certa/io.h>
#include <certa/remeshing.h>
#include <certa/surface_check.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>

namespace certa {
namespace {

/// Clean: manifold, oriented, and nowhere in contact with itself.
TEST(RemeshModelsLong, AreSoundAtDefaultOptions) {
    const char* folder = std::getenv("CERTA_MODELS");
    if (folder == nullptr || !std::filesystem::exists(std::filesystem::path(folder) / "INDEX.tsv"))
        GTEST_SKIP() << "needs CERTA_MODELS";
    std::vector<std::filesystem::path> files;
    for (const char* part : {"cad", "scan", "surfaces"})
        for (const auto& entry : std::filesystem::directory_iterator(std::filesystem::path(folder) / part))
            if (entry.path().extension() != ".md") files.push_back(entry.path());
    std::sort(files.begin(), files.end());
    std::size_t clean = 0;
    for (const auto& file : files) {
        SCOPED_TRACE(file.filename());
        const TriangleMesh input = triangulate(read_document(file.string())).mesh;
        const PolygonMesh polygons = make_polygon_mesh(input);
        if (!compute_surface_shape(polygons).is_oriented() || !find_contacts(polygons).empty()) continue;
        ++clean;
        const RemeshResult result = remesh(input);
        ASSERT_EQ(result.outcome, Outcome::done);
        const SurfaceCheck check = check_surface(result.mesh, polygons);
        for (const Violation& violation : check.violations)
            ADD_FAILURE() << violation.promise << ": " << violation.message;
    }
    EXPECT_GT(clean, 40U);
}

}  // namespace
}  // namespace certa
