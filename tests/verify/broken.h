#pragma once
// What the tests of broken meshes share: expectations, and the valid meshes that they break.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "verify/grid_mesh.h"

namespace certa::test {

inline void expect_broken(const Case& c, const std::string& promise, const ConformingCheckOptions& options = {}) {
    const ConformingCheck check = check_conforming(c.mesh, c.complex, options);
    EXPECT_FALSE(check.ok());
    EXPECT_TRUE(has(check, promise)) << "expected " << promise << ", found:\n" << text(check);
    EXPECT_GE(check.violation_count, check.violations.size());
}
inline bool tells(const Case& c, const std::string& words, const ConformingCheckOptions& options = {}) {
    return text(check_conforming(c.mesh, c.complex, options)).find(words) != std::string::npos;
}
inline void expect_fine(const Case& c, const ConformingCheckOptions& options = {}) {
    const ConformingCheck check = check_conforming(c.mesh, c.complex, options);
    EXPECT_TRUE(check.ok()) << text(check);
}

/// A box of 3 x 3 x 3 with added points on sides and in facets, a wall inside, a dangling segment.
inline Case base() {
    GridMesh grid(3, 3, 3);
    grid.box({0, 0, 0}, {3, 3, 3});
    grid.box({1, 1, 1}, {2, 2, 2});
    grid.region_of = [](const Place& p) { return p == Place{1, 1, 1} ? 2 : 1; };
    return grid.make();
}
inline Case base_outside_kept() {
    GridMesh grid(4, 4, 4);
    grid.box({1, 1, 1}, {3, 3, 3});
    grid.region_of = [](const Place& p) {
        return std::all_of(p.begin(), p.end(), [](int c) { return c == 1 || c == 2; }) ? 1 : 0;
    };
    return grid.make();
}
inline std::vector<Case> all_bases() { return {base(), base_outside_kept(), one_tetrahedron(), cube_of_five()}; }

template <class T>
inline void erase_at(std::vector<T>& values, std::size_t i) {
    values.erase(values.begin() + static_cast<std::ptrdiff_t>(i));
}

inline std::uint32_t find_vertex(const Case& c, const Point3& p) {
    for (std::uint32_t v = 0; v < c.mesh.positions.size(); ++v) {
        if (c.mesh.positions[v] == p) return v;
    }
    return no_index;
}

}  // namespace certa::test
