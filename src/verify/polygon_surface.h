#pragma once
// A polygon mesh as a surface: which triangulations its polygons may have, and the one that it is measured on.
#include <certa/error.h>
#include <certa/mesh.h>
#include <certa/run_control.h>

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "core/triangle_tree.h"

namespace certa::verify {

/// Appends what keeps `mesh` from being a surface at all; `name` begins the messages.
void find_polygon_defects(const PolygonMesh& mesh, const std::string& name, std::vector<Defect>& defects);

/// The exponent e for which 2^-e times all coordinates are at most 1.
int find_exponent(const PolygonMesh& first, const PolygonMesh& second);

class PolygonSurface {
public:
    using Corners = std::array<std::uint32_t, 3>;  // vertices

    /// Needs a mesh without defects; positions are scaled by 2^-exponent.
    PolygonSurface(const PolygonMesh& mesh, int exponent);

    /// Takes for each polygon the triangulation whose diagonals are nearest to the triangles of `other`.
    void choose(const core::TriangleTree& other, const RunControl& control);

    std::size_t polygon_count() const { return offsets_.size() - 1; }
    std::span<const std::uint32_t> polygon(std::size_t q) const {
        return {corners_.data() + offsets_[q], offsets_[q + 1] - offsets_[q]};
    }
    /// The polygon across the side from corner i to the next; no_index unless exactly one other polygon is there.
    std::uint32_t across(std::size_t q, std::size_t i) const { return across_[offsets_[q] + i]; }
    /// Whether that polygon walks the side the same way, as none should.
    bool walks_alike(std::size_t q, std::size_t i) const { return walks_alike_[offsets_[q] + i]; }
    /// Triangles that occur in a triangulation of q.
    std::span<const Corners> possible(std::size_t q) const {
        return {possible_.data() + possible_offsets_[q], possible_offsets_[q + 1] - possible_offsets_[q]};
    }
    /// Triangulation k of q as indices into possible(q).
    std::size_t choice_count(std::size_t q) const {
        return (choice_offsets_[q + 1] - choice_offsets_[q]) / (polygon(q).size() - 2);
    }
    std::span<const std::uint32_t> choice(std::size_t q, std::size_t k) const {
        const std::size_t size = polygon(q).size() - 2;
        return {choices_.data() + choice_offsets_[q] + k * size, size};
    }
    /// How far triangulations of q that are not listed may be from the listed one.
    double slack(std::size_t q) const { return slacks_[q]; }
    bool has_choices() const { return has_choices_; }

    const std::vector<Point3>& positions() const { return positions_; }
    /// The chosen triangulations.
    const std::vector<Triangle>& triangles() const { return triangles_; }
    std::uint32_t polygon_of(std::size_t triangle) const { return polygon_of_[triangle]; }
    std::array<Point3, 3> points(const Corners& t) const {
        return {positions_[t[0]], positions_[t[1]], positions_[t[2]]};
    }
    std::array<Point3, 3> points_of_triangle(std::size_t t) const {
        return {positions_[index_of(triangles_[t][0])], positions_[index_of(triangles_[t][1])],
                positions_[index_of(triangles_[t][2])]};
    }

private:
    void connect();
    void list_triangulations(std::size_t q);
    void list_one(std::size_t q, const Point3& normal);
    void fill_triangles();
    std::size_t find_best_choice(std::size_t q, const core::TriangleTree& other) const;

    std::vector<Point3> positions_;
    std::vector<std::uint32_t> corners_, offsets_, across_;
    std::vector<bool> walks_alike_;  // parallel to across_
    std::vector<Corners> possible_;
    std::vector<std::uint32_t> possible_offsets_{0}, choices_, choice_offsets_{0};
    std::vector<double> slacks_;
    std::vector<std::uint32_t> chosen_;
    std::vector<Triangle> triangles_;
    std::vector<std::uint32_t> polygon_of_;
    bool has_choices_ = false;
};

}  // namespace certa::verify
