// The octree from its string, T from the rule "an edge or square is subdivided if its midpoint is a corner of a leaf",
// signs and marks from the lists. Written from docs/implicit-theorem.md and docs/formats.md, not from the mesher.
#include "verify/implicit_complex.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace certa::verify {
namespace {

constexpr std::uint32_t leaf_bit = 0x80000000u;

[[noreturn]] void refuse(const std::string& reason) { throw UnreadableCertificate(reason); }

}  // namespace

std::size_t LatticePoints::slot_of(const Lattice& p) const {
    std::uint64_t h = 1469598103934665603ull;
    for (const std::uint32_t c : p) h = (h ^ c) * 0x9ddfea08eb382d69ull, h ^= h >> 32;
    std::size_t slot = static_cast<std::size_t>(h) & (slots_.size() - 1);
    while (slots_[slot] != free && points_[slots_[slot]] != p) slot = (slot + 1) & (slots_.size() - 1);
    return slot;
}

std::uint32_t LatticePoints::add(const Lattice& p) {
    std::size_t slot = slot_of(p);
    if (slots_[slot] != free) return slots_[slot];
    const auto number = static_cast<std::uint32_t>(points_.size());
    points_.push_back(p);
    if (2 * points_.size() <= slots_.size()) {
        slots_[slot] = number;
        return number;
    }
    slots_.assign(2 * slots_.size(), free);
    for (std::uint32_t i = 0; i <= number; ++i) slots_[slot_of(points_[i])] = i;
    return number;
}

BoxOfDoubles box_of(const ImplicitCertificate& certificate) {
    BoxOfDoubles box{};
    for (std::size_t a = 0; a < 3; ++a) {
        const std::int64_t first = certificate.first[a], last = first + certificate.count[a];
        constexpr std::int64_t limit = std::int64_t{1} << 53;
        if (first < -limit || last > limit || certificate.count[a] <= 0 || std::abs(certificate.exponent[a]) > 900)
            refuse("the corners of the box are not doubles");
        box.low[a] = std::ldexp(static_cast<double>(first), static_cast<int>(certificate.exponent[a]));
        box.high[a] = std::ldexp(static_cast<double>(last), static_cast<int>(certificate.exponent[a]));
    }
    return box;
}

ImplicitComplex::ImplicitComplex(const ImplicitCertificate& certificate)
    : first_(certificate.first),
      count_(certificate.count),
      exponent_(certificate.exponent),
      clipped_(certificate.clip) {
    if (certificate.resolution < 2 || certificate.resolution > 30) refuse("the resolution must be from 2 to 30");
    resolution_ = static_cast<int>(certificate.resolution);
    for (std::size_t a = 0; a < 3; ++a) {
        // Then every grid point is a double: an integer of at most 53 bits times a power of two within range.
        const std::int64_t limit = std::int64_t{1} << (53 - resolution_);
        if (count_[a] <= 0 || first_[a] < -limit || first_[a] > limit || first_[a] + count_[a] > limit)
            refuse("the grid's points are not all doubles");
        if (exponent_[a] < -900 || exponent_[a] > 900) refuse("the grid's exponent is out of range");
    }
    read_octree(certificate.octree);
    build_tets();
    settle_signs(certificate);
    marks = points_from(certificate.marks, "marks");
}

double ImplicitComplex::place(std::size_t axis, std::uint32_t i) const {
    // first 2^resolution + count i: both at most 2^53.
    const std::int64_t whole =
        first_[axis] * static_cast<std::int64_t>(side()) + count_[axis] * static_cast<std::int64_t>(i);
    return std::ldexp(static_cast<double>(whole), static_cast<int>(exponent_[axis]) - resolution_);
}

std::array<double, 3> ImplicitComplex::place(std::uint32_t point) const {
    return {place(0, points()[point][0]), place(1, points()[point][1]), place(2, points()[point][2])};
}

BoxOfDoubles ImplicitComplex::box(const Lattice& low, const Lattice& high) const {
    BoxOfDoubles box{};
    for (std::size_t a = 0; a < 3; ++a) {
        box.low[a] = place(a, low[a]);
        box.high[a] = place(a, high[a]);
    }
    return box;
}

bool ImplicitComplex::on_boundary(const Lattice& p) const {
    return std::any_of(p.begin(), p.end(), [&](std::uint32_t c) { return c == 0 || c == side(); });
}

unsigned ImplicitComplex::box_faces(const Lattice& p) const {
    unsigned faces = 0;
    for (std::size_t a = 0; a < 3; ++a) {
        if (p[a] == 0) faces |= 1u << (2 * a);
        if (p[a] == side()) faces |= 2u << (2 * a);
    }
    return faces;
}

void ImplicitComplex::read_octree(const std::string& code) {
    std::size_t at = 0;
    read_cell(code, at, {0, 0, 0}, side());
    if (at != code.size()) refuse("the octree's text goes on after its end");
    corner_count_ = static_cast<std::uint32_t>(points_.all().size());
}

void ImplicitComplex::read_cell(const std::string& code, std::size_t& at, const Lattice& low, std::uint32_t size) {
    if (at == code.size()) refuse("the octree's text ends early");
    const char c = code[at++];
    const std::size_t node = nodes_.size();
    nodes_.push_back(0);
    if (c == '(') {
        if (size <= 2) refuse("the octree is deeper than its grid");
        const std::uint32_t half = size / 2;
        // Children may be anywhere in preorder: their places follow the node.
        nodes_.resize(nodes_.size() + 8);
        for (std::uint32_t k = 0; k < 8; ++k) {
            nodes_[node + 1 + k] = static_cast<std::uint32_t>(nodes_.size());
            read_cell(code, at, {low[0] + (k & 1u) * half, low[1] + ((k >> 1) & 1u) * half, low[2] + (k >> 2) * half},
                      half);
        }
        return;
    }
    if (c < 'a' || c > 'u') refuse("the octree's text has a strange letter");
    ClaimedLeaf leaf;
    leaf.low = low;
    leaf.size = size;
    leaf.sign = (c - 'a') / 7 - 1;
    if (const int slope = (c - 'a') % 7; slope != 0) {
        leaf.axis = (slope - 1) / 2;
        leaf.slope = (slope - 1) % 2 == 1 ? 1 : -1;
    }
    nodes_[node] = leaf_bit | static_cast<std::uint32_t>(leaves_.size());
    leaves_.push_back(leaf);
    for (unsigned k = 0; k < 8; ++k)
        points_.add({low[0] + (k & 1u) * size, low[1] + ((k >> 1) & 1u) * size, low[2] + (k >> 2) * size});
}

std::uint32_t ImplicitComplex::leaf_at(const Lattice& p) const {
    std::uint32_t node = 0;
    for (int shift = resolution_ - 1; (nodes_[node] & leaf_bit) == 0; --shift) {
        const std::uint32_t k = ((p[0] >> shift) & 1u) | (((p[1] >> shift) & 1u) << 1) | (((p[2] >> shift) & 1u) << 2);
        node = nodes_[node + 1 + k];
    }
    return nodes_[node] & ~leaf_bit;
}

void ImplicitComplex::build_tets() {
    for (std::uint32_t i = 0; i < leaves_.size(); ++i) {
        const ClaimedLeaf leaf = leaves_[i];
        const std::uint32_t half = leaf.size / 2;
        const std::uint32_t apex = points_.add({leaf.low[0] + half, leaf.low[1] + half, leaf.low[2] + half});
        for (std::size_t axis = 0; axis < 3; ++axis) {
            Lattice upper = leaf.low;
            upper[axis] += leaf.size;
            cone_square(i, apex, leaf.low, axis, false, leaf.size);
            cone_square(i, apex, upper, axis, true, leaf.size);
        }
    }
}

void ImplicitComplex::cone_square(std::uint32_t leaf, std::uint32_t apex, const Lattice& low, std::size_t axis,
                                  bool upper, std::uint32_t size) {
    const std::size_t u = (axis + 1) % 3, v = (axis + 2) % 3;
    const std::uint32_t half = size / 2;
    const auto moved = [&](std::uint32_t du, std::uint32_t dv) {
        Lattice p = low;
        p[u] += du;
        p[v] += dv;
        return p;
    };
    if (half > 0 && is_corner(moved(half, half))) {
        for (unsigned k = 0; k < 4; ++k)
            cone_square(leaf, apex, moved((k & 1u) * half, (k >> 1) * half), axis, upper, half);
        return;
    }
    const std::uint32_t middle = points_.add(moved(half, half));
    std::vector<std::uint32_t> ring;
    walk_edge(moved(0, 0), moved(size, 0), ring);
    walk_edge(moved(size, 0), moved(size, size), ring);
    walk_edge(moved(size, size), moved(0, size), ring);
    walk_edge(moved(0, size), moved(0, 0), ring);
    for (std::size_t i = 0; i < ring.size(); ++i) {
        const std::uint32_t a = ring[i], b = ring[(i + 1) % ring.size()];
        tets_.push_back(upper ? Tet{apex, middle, a, b} : Tet{apex, middle, b, a});
        leaf_of_tet_.push_back(leaf);
    }
}

void ImplicitComplex::walk_edge(const Lattice& a, const Lattice& b, std::vector<std::uint32_t>& ring) {
    Lattice middle{};
    std::uint32_t length = 0;
    for (std::size_t i = 0; i < 3; ++i) {
        middle[i] = static_cast<std::uint32_t>((std::uint64_t{a[i]} + b[i]) / 2);
        length = std::max(length, a[i] > b[i] ? a[i] - b[i] : b[i] - a[i]);
    }
    if (length < 2 || !is_corner(middle)) {
        ring.push_back(points_.add(a));
        return;
    }
    walk_edge(a, middle, ring);
    walk_edge(middle, b, ring);
}

void ImplicitComplex::settle_signs(const ImplicitCertificate& certificate) {
    sign.assign(points().size(), 0);
    for (std::size_t i = 0; i < tets_.size(); ++i) {
        const int claimed = leaves_[leaf_of_tet_[i]].sign;
        if (claimed == 0) continue;
        for (const std::uint32_t p : tets_[i]) {
            if (sign[p] == -claimed) contradiction = "leaves around one point claim different signs";
            sign[p] = static_cast<std::int8_t>(claimed);
        }
    }
    for (const std::uint32_t p : points_from(certificate.negative_points, "negative_points")) {
        if (sign[p] > 0) contradiction = "a negative point lies in a leaf with a positive sign";
        sign[p] = -1;
    }
    for (std::int8_t& s : sign) {
        if (s == 0) s = 1;
    }
}

std::vector<std::uint32_t> ImplicitComplex::points_from(const std::vector<std::int64_t>& numbers,
                                                        const char* what) const {
    if (numbers.size() % 3 != 0) refuse(std::string(what) + ": not three numbers a point");
    std::vector<std::uint32_t> result;
    for (std::size_t i = 0; i < numbers.size(); i += 3) {
        Lattice p{};
        for (std::size_t a = 0; a < 3; ++a) {
            if (numbers[i + a] < 0 || numbers[i + a] > std::int64_t{side()})
                refuse(std::string(what) + ": a point off the grid");
            p[a] = static_cast<std::uint32_t>(numbers[i + a]);
        }
        const std::uint32_t id = find(p);
        if (id == no_point) refuse(std::string(what) + ": a point that is none of the triangulation");
        result.push_back(id);
    }
    return result;
}

}  // namespace certa::verify
