#pragma once
// What the two halves of compute_info share.
#include <certa/info.h>

#include <cstdint>
#include <numeric>
#include <vector>

namespace certa::mesh {

/// Union-find over indices; the representative of a set is its smallest element.
class Forest {
public:
    explicit Forest(std::size_t size) : parent_(size) { std::iota(parent_.begin(), parent_.end(), 0U); }
    std::uint32_t find(std::uint32_t i) {
        while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
        return i;
    }
    void join(std::uint32_t a, std::uint32_t b) {
        a = find(a);
        b = find(b);
        if (a < b)
            parent_[b] = a;
        else
            parent_[a] = b;
    }

private:
    std::vector<std::uint32_t> parent_;
};

TetrahedraInfo compute_tetrahedra_info(const MeshDocument& document);

}  // namespace certa::mesh
