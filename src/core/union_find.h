#pragma once
// Disjoint sets of indices; the lowest index stands for its set, so that results do not depend on the order of unions.
#include <algorithm>
#include <cstdint>
#include <numeric>
#include <vector>

namespace certa::core {

class UnionFind {
public:
    explicit UnionFind(std::size_t count) : parents_(count) { std::iota(parents_.begin(), parents_.end(), 0u); }

    std::uint32_t find(std::uint32_t i) {
        while (parents_[i] != i) i = parents_[i] = parents_[parents_[i]];
        return i;
    }
    /// Whether i stands for its set; may be asked by several threads at once.
    bool is_leader(std::uint32_t i) const { return parents_[i] == i; }
    /// Returns whether the two were in different sets.
    bool unite(std::uint32_t a, std::uint32_t b) {
        a = find(a);
        b = find(b);
        parents_[std::max(a, b)] = std::min(a, b);
        return a != b;
    }

private:
    std::vector<std::uint32_t> parents_;
};

}  // namespace certa::core
