#pragma once
// The checker's own octree, triangulation and W, made from what a certificate says.
#include <array>
#include <cstdint>
#include <functional>
#include <string>
#include <unordered_map>
#include <vector>

#include "verify/implicit_certificate.h"
#include "verify/implicit_function.h"

namespace certa::verify {

using Lattice = std::array<std::uint32_t, 3>;  ///< a point of the grid
struct LatticeHash {
    std::size_t operator()(const Lattice& p) const {
        std::uint64_t h = 1469598103934665603ull;
        for (const std::uint32_t c : p) h = (h ^ c) * 0x100000001b3ull;
        return static_cast<std::size_t>(h ^ (h >> 31));
    }
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
    const std::vector<Lattice>& points() const { return points_; }
    std::uint32_t find(const Lattice& p) const;  ///< the point of T, or no_point
    static constexpr std::uint32_t no_point = 0xffffffffu;

    /// Signs of points: of the leaves around where claimed, else as the certificate lists them.
    std::vector<int> sign;
    /// Order of marks: points of T.
    std::vector<std::uint32_t> marks;
    std::string contradiction;  ///< leaves around a point that claim different signs

    /// The leaf that holds the unit cube above p.
    std::uint32_t leaf_at(const Lattice& p) const;
    /// Whether an octree edge or square with this midpoint is subdivided.
    bool is_corner(const Lattice& p) const { return corners_.count(p) != 0; }

private:
    void read_octree(const std::string& code);
    void read_cell(const std::string& code, std::size_t& at, const Lattice& low, std::uint32_t size);
    void build_tets();
    void cone_square(std::uint32_t leaf, std::uint32_t apex, const Lattice& low, std::size_t axis, bool upper,
                     std::uint32_t size);
    void walk_edge(const Lattice& a, const Lattice& b, std::vector<std::uint32_t>& ring);
    void settle_signs(const ImplicitCertificate& certificate);
    std::uint32_t point(const Lattice& p);
    std::vector<std::uint32_t> points_from(const std::vector<std::int64_t>& numbers, const char* what) const;

    std::array<std::int64_t, 3> first_, count_, exponent_;
    int resolution_ = 0;
    bool clipped_ = false;
    std::vector<ClaimedLeaf> leaves_;
    std::vector<std::uint32_t> nodes_;  ///< preorder: first child's node, or leaf number with the top bit
    std::unordered_map<Lattice, char, LatticeHash> corners_;
    std::unordered_map<Lattice, std::uint32_t, LatticeHash> ids_;
    std::vector<Lattice> points_;
    std::vector<Tet> tets_;
    std::vector<std::uint32_t> leaf_of_tet_;
    friend class MeshOnComplex;
};

}  // namespace certa::verify
