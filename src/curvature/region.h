#pragma once
// Regions compiled for clipping: the three exact questions |e in B|, area(t in B), p in B.
#include "curvature/cells.h"

namespace certa::curvature {

/// A region in the surface's units, its primitives numbered.
class CompiledRegion {
public:
    /// Errors: InputError option_out_of_range, index_out_of_range.
    CompiledRegion(const Region& region, const Surface& surface);

    bool has_faces() const { return has_faces_; }
    bool has_predicates() const { return has_predicates_; }
    /// Membership of a point, seen from a face (no_index: from none).
    bool holds(const Point3& point, Index face) const { return evaluate(0, point, face, nullptr); }
    /// Parameters in (0, 1) where the segment crosses the border of a ball or half-space, sorted.
    void crossings(const Point3& a, const Point3& b, std::vector<double>& parameters) const;
    /// Area of the face inside, without predicates.
    double area_inside(Index face) const;

private:
    struct Primitive {
        Region::Kind kind = Region::Kind::ball;  // ball, half_space, faces or predicate
        Point3 point, normal;                    // half-space: unit normal
        double radius = 0.0;
        std::vector<bool> faces;
        std::function<bool(const Point3&)> predicate;
        /// The first primitive with the same border, and whether this one lies on the other side of it.
        std::size_t twin = 0;
        bool opposite = false;
    };
    struct Node {
        Region::Kind kind = Region::Kind::everything;
        std::size_t primitive = 0;
        std::vector<std::size_t> parts;
    };
    /// A ball or half-space cut by the plane of a face: |x - center|^2 <= square, or normal . x <= offset.
    struct Curve {
        std::size_t primitive = 0;
        bool is_circle = false;
        std::array<double, 2> center{}, normal{};
        double square = 0.0, offset = 0.0;
    };
    struct Cut;

    std::size_t compile(const Region& region, const Surface& surface);
    std::size_t add_half_space(const Point3& point, const Point3& normal);
    std::size_t add_primitive(Primitive primitive);
    bool evaluate(std::size_t node, const Point3& point, Index face, const std::vector<signed char>* forced) const;
    bool primitive_holds(const Primitive& primitive, const Point3& point, Index face) const;
    bool cuts(const Primitive& primitive, const std::array<Point3, 3>& corners) const;

    const Surface& surface_;
    std::vector<Primitive> primitives_;
    std::vector<Node> nodes_;
    bool has_faces_ = false, has_predicates_ = false;
};

/// The measures of the region; `undecided` receives the area that predicates left open, `faces` the faces that meet it.
Sums measure_region(const Surface& surface, const Cells& cells, const CompiledRegion& region, Rim rim, double tolerance,
                    double& undecided, std::vector<Index>& faces, const RunControl& control);

}  // namespace certa::curvature
