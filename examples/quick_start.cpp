// A block with a fin inside: the fin meets the floor at a sharp angle and cuts the block into two regions.
// Builds the complex, meshes it, checks the result independently, writes it to a file.
#include <certa/conforming.h>
#include <certa/io.h>

#include <algorithm>
#include <cstdio>

namespace {

certa::PiecewiseLinearComplex make_block_with_fin() {
    certa::PiecewiseLinearComplex complex;
    complex.positions = {{0, 0, 0},   {4, 0, 0},  {4, 1, 0}, {0, 1, 0},  // floor
                         {0, 0, 1},   {4, 0, 1},  {4, 1, 1}, {0, 1, 1},  // ceiling
                         {4, 0, 0.5}, {4, 1, 0.5}};                      // the fin rises from x = 0 to these two
    const auto facet = [&](std::initializer_list<std::uint32_t> corners) {
        std::vector<certa::VertexId> ring;
        for (const std::uint32_t corner : corners) ring.push_back(certa::VertexId{corner});
        certa::add_facet(complex, {ring});
    };
    facet({0, 3, 2, 1});
    facet({4, 5, 6, 7});
    facet({0, 1, 8, 5, 4});
    facet({3, 7, 6, 9, 2});
    facet({0, 4, 7, 3});
    facet({1, 2, 9, 8});
    facet({8, 9, 6, 5});
    facet({0, 8, 9, 3});  // the fin, at 7 degrees above the floor
    // Where the fin touches the side walls.
    complex.segments = {{certa::VertexId{0}, certa::VertexId{8}}, {certa::VertexId{3}, certa::VertexId{9}}};
    return complex;
}

}  // namespace

int main() {
    try {
        const certa::PiecewiseLinearComplex complex = make_block_with_fin();
        const certa::ConformResult result = certa::conform(complex);
        if (result.outcome != certa::Outcome::done) return 1;

        const certa::ConformingCheck check = certa::check_conforming(result.mesh, complex);
        const auto last_region =
            std::max_element(result.mesh.tetrahedron_regions.begin(), result.mesh.tetrahedron_regions.end());
        std::printf("%zu vertices, %zu tetrahedra, %u regions: %s\n", result.mesh.positions.size(),
                    result.mesh.tetrahedra.size(), certa::index_of(*last_region), check.ok() ? "verified" : "WRONG");
        certa::write_document("block.vtu", certa::make_document(result.mesh, complex, certa::Reference::id));
        return check.ok() ? 0 : 1;
    } catch (const certa::InputError& error) {
        for (const certa::Defect& defect : error.defects()) std::fprintf(stderr, "%s\n", defect.message.c_str());
    } catch (const certa::IoError& error) {
        std::fprintf(stderr, "%s\n", error.what());
    }
    return 1;
}
