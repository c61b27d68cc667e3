#pragma once
// The checker's own octree, triangulation and W, made from what a certificate says.
#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "verify/implicit_certificate.h"
#include "verify/implicit_function.h"

namespace certa::verify {

using Lattice = std::array<std::uint32_t, 3>;  ///< a point of the grid

/// Points of the grid, numbered in the order in which they were added. Open addressing: a table of numbers only.
class LatticePoints {
public:
    LatticePoints() : slots_(1u << 10, free) {}
    static constexpr std::uint32_t free = 0xffffffffu;
    std::uint32_t add(const Lattice& p);
    /// The number of a point, or `free`.
    std::uint32_t find(const Lattice& p) const { return slots_[slot_of(p)]; }
    const std::vector<Lattice>& all() const { return points_; }

private:
    std::size_t slot_of(const Lattice& p) const;
    std::vector<Lattice> points_;
    std::vector<std::uint32_t> slots_;
};

struct ClaimedLeaf {
    Lattice low{};
    std::uint32_t size = 0;
    int sign = 0;              ///< claimed of f
    int axis = -1, slope = 0;  ///< claimed of a derivative
    bool is_critical() const { return sign != 0 && slope == 0; }
};

/// The box of a certificate. Errors: UnreadableCertificate where its corners are not doubles.
BoxOfDoubles box_of(const ImplicitCertificate& certificate);

/// Everything is built for the whole box, not only near the surface as the mesher does.
/// Errors: UnreadableCertificate where the certificate describes no octree or names points that are none of T.
class ImplicitComplex {
public:
    explicit ImplicitComplex(const ImplicitCertificate& certificate);

    const std::vector<ClaimedLeaf>& leaves() const { return leaves_; }
    double place(std::size_t axis, std::uint32_t i) const;
    BoxOfDoubles box(const Lattice& low, const Lattice& high) const;
    std::array<double, 3> place(std::uint32_t point) const;
    std::uint32_t side() const { return std::uint32_t{1} << resolution_; }
    bool on_boundary(const Lattice& p) const;
    bool is_clipped() const { return clipped_; }
    /// Faces of the box that hold a point, a bit each: low x, high x, low y, ...
    unsigned box_faces(const Lattice& p) const;

    using Tet = std::array<std::uint32_t, 4>;
    const std::vector<Tet>& tets() const { return tets_; }
    const std::vector<std::uint32_t>& leaf_of_tet() const { return leaf_of_tet_; }
    const std::vector<Lattice>& points() const { return points_.all(); }
    std::uint32_t find(const Lattice& p) const { return points_.find(p); }  ///< the point of T, or no_point
    static constexpr std::uint32_t no_point = LatticePoints::free;

    /// Signs of points: of the leaves around where claimed, else as the certificate lists them.
    std::vector<std::int8_t> sign;
    /// Order of marks: points of T.
    std::vector<std::uint32_t> marks;
    std::string contradiction;  ///< leaves around a point that claim different signs

    /// The leaf that holds the unit cube above p.
    std::uint32_t leaf_at(const Lattice& p) const;
    /// Whether an octree edge or square with this midpoint is subdivided.
    bool is_corner(const Lattice& p) const { return points_.find(p) < corner_count_; }

private:
    void read_octree(const std::string& code);
    void read_cell(const std::string& code, std::size_t& at, const Lattice& low, std::uint32_t size);
    void build_tets();
    void cone_square(std::uint32_t leaf, std::uint32_t apex, const Lattice& low, std::size_t axis, bool upper,
                     std::uint32_t size);
    void walk_edge(const Lattice& a, const Lattice& b, std::vector<std::uint32_t>& ring);
    void settle_signs(const ImplicitCertificate& certificate);
    std::vector<std::uint32_t> points_from(const std::vector<std::int64_t>& numbers, const char* what) const;

    std::array<std::int64_t, 3> first_, count_, exponent_;
    int resolution_ = 0;
    bool clipped_ = false;
    std::vector<ClaimedLeaf> leaves_;
    std::vector<std::uint32_t> nodes_;  ///< preorder: first child's node, or leaf number with the top bit
    LatticePoints points_;              ///< corners of leaves first
    std::uint32_t corner_count_ = 0;
    std::vector<Tet> tets_;
    std::vector<std::uint32_t> leaf_of_tet_;
    friend class MeshOnComplex;
};

}  // namespace certa::verify
