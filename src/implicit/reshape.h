#pragma once
// A closed triangle mesh near a zero set that is changed step by step, and never touches itself nor the frontier of W.
#include <certa/mesh.h>

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "implicit/field.h"
#include "implicit/frontier.h"
#include "implicit/surface.h"

namespace certa::implicit {

/// How good some triangles are, as sampled: the least good of each kind.
struct Fitness {
    double error = 0;      ///< largest estimate of the distance to the zero set: |f| / |grad f|
    double angle = 4;      ///< smallest angle, radians
    double alignment = 1;  ///< smallest cosine between normal and gradient
};

/// Vertices and triangles have fixed numbers; some die. Every change replaces the triangles around some place by others
/// with the same boundary, and is made only if the new ones keep apart from each other, from all other triangles and
/// from the frontier, by tests with a margin (separation.h): so the mesh stays embedded and in W.
class Reshaper {
public:
    using Triple = std::array<std::uint32_t, 3>;
    Reshaper(const Surface& surface, const Frontier* frontier, Field& field);

    std::size_t vertex_count() const { return positions_.size(); }
    std::size_t triangle_count() const { return triangles_.size(); }
    std::size_t living_triangles() const { return living_; }
    bool is_alive(std::uint32_t t) const { return alive_[t] != 0; }
    const Triple& triangle(std::uint32_t t) const { return triangles_[t]; }
    const Point3& position(std::uint32_t v) const { return positions_[v]; }
    const Point3& normal(std::uint32_t v) const { return normals_[v]; }  ///< unit gradient
    std::span<const std::uint32_t> around(std::uint32_t v) const { return around_[v]; }
    /// Neighbours of a vertex, each once, sorted.
    std::vector<std::uint32_t> neighbours(std::uint32_t v) const;
    /// The two triangles at an edge.
    std::array<std::uint32_t, 2> at_edge(std::uint32_t a, std::uint32_t b) const;
    Corners corners(const Triple& t) const { return {positions_[t[0]], positions_[t[1]], positions_[t[2]]}; }

    Fitness fitness(const Corners& t);
    Fitness fitness(std::span<const std::uint32_t> triangles);
    /// The zero of f near a place along its gradient, as doubles find it; the place itself where that fails.
    Point3 project(const Point3& place);

    // Each returns false, without a change, where the result would not do. `wanted` bounds the new triangles: at most
    // that error, at least that angle and alignment.

    /// Merges the edge's ends into a vertex at `place`, which has the number `a`.
    bool collapse(std::uint32_t a, std::uint32_t b, const Point3& place, const Fitness& wanted);
    bool flip(std::uint32_t a, std::uint32_t b, const Fitness& wanted);
    bool move(std::uint32_t v, const Point3& place, const Fitness& wanted);
    /// Puts a new vertex on an edge; its number, or no_index.
    std::uint32_t split(std::uint32_t a, std::uint32_t b, const Point3& place, const Fitness& wanted);

    /// To be called now and then, when sizes have changed: searches go on faster.
    void sort_by_place();
    Surface take() const;

private:
    bool replace(std::span<const std::uint32_t> old, std::span<const Triple> fresh, const Fitness& wanted);
    bool keeps_apart(const Triple& t, std::span<const Triple> fresh, std::size_t position);
    bool pair_apart(const Triple& s, const Triple& t) const;
    void set_place(std::uint32_t v, const Point3& place);

    const Frontier* frontier_;
    Field& field_;
    std::vector<Point3> positions_, normals_;
    std::vector<Triple> triangles_;
    std::vector<char> alive_;
    std::vector<std::uint32_t> components_;
    std::vector<std::vector<std::uint32_t>> around_;
    std::size_t living_ = 0;
    TriangleGrid grid_;
    std::vector<std::uint32_t> near_;  ///< scratch
};

}  // namespace certa::implicit
