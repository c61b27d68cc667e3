#pragma once
// The growth of W: which points of T join it, in which order.
#include <certa/run_control.h>

#include <cstdint>
#include <span>
#include <vector>

#include "implicit/triangulation.h"

namespace certa::implicit {

/// W is the subcomplex of T of all simplices whose points are all marked.
struct Growth {
    std::vector<char> marked;          ///< per point
    std::vector<std::uint32_t> order;  ///< marked points in the order of marking: the certificate of the collapse
};

/// The links of points that may join, as bit masks, kept between rounds of refinement where stars do not change.
class LinkCache {
public:
    struct Link {
        const std::uint32_t* points;
        const std::uint64_t* masks;  ///< per point of the link, a bit for each neighbour in the link
        std::size_t count;           ///< 0: more than 64 points, not kept
    };
    /// To be called for each triangulation: makes, in parallel, the links that are new or may have changed.
    void begin_round(const Triangulation& triangulation, const RunControl& control);
    /// The link of a point that may join and is on no face of a box that clips.
    Link link_of(std::uint32_t point) const {
        const Entry& entry = entries_[point];
        return {points_.data() + entry.first, masks_.data() + entry.first, entry.count};
    }

private:
    struct Entry {
        std::size_t first = 0;
        std::uint32_t count = 0;
        bool built = false;
    };
    /// Links that one thread made, one after the other.
    struct Part {
        std::vector<std::uint32_t> points, counts;
        std::vector<std::uint64_t> masks;
        void add(const Triangulation& triangulation, std::uint32_t point);
    };
    std::vector<Entry> entries_;
    std::vector<std::uint32_t> points_;
    std::vector<std::uint64_t> masks_;
};

/// Marks points as long as some may join.
///
/// Definition: a point v may join when, in its link, the part spanned by points of the other sign and marked points is
/// non-empty and
///             connected, and so is the part spanned by the other points (then the first part is contractible, the link
///             being a sphere). On the boundary of a box that clips, the link is a disk: it is closed by a cone from an
///             unmarked point over its rim, and the rim must change kind exactly twice, on an edge of the box exactly
///             once in each of the two faces. Each step adds a cone over a contractible set, so W collapses to the
///             surface of sign changes (Lemma 51), once every tetrahedron with both signs has all its points marked.
/// `links` is kept for the triangulation that follows from this one.
Growth grow(const Triangulation& triangulation, LinkCache& links, const RunControl& control);
Growth grow(const Triangulation& triangulation);
/// Of the points that may join, those with lower ranks (per point) go first: where fronts meet and stop, ranks are
/// high.
Growth grow(const Triangulation& triangulation, std::span<const float> ranks, const RunControl& control);

/// The thesis's watershed (Part III, 1.7.1; Lemma 52): in the order of their sizes |f(p)|, ties by number, points join
/// whose smaller neighbours of their sign have all joined, if they may: those that flow into no critical point.
Growth grow_watershed(const Triangulation& triangulation, std::span<const double> sizes);

/// Whether one point may join now; the test of the definition above.
class LinkTest {
public:
    explicit LinkTest(std::size_t point_count) : index_(point_count, none) {}
    bool may_join(const Triangulation& triangulation, const std::vector<char>& marked, std::uint32_t point);
    /// The points of the link that was tested last.
    const std::vector<std::uint32_t>& link() const { return link_; }

private:
    std::uint32_t local(std::uint32_t point);
    std::uint32_t find(std::uint32_t i);
    bool close_rim(const Triangulation& triangulation, std::uint32_t point);
    std::vector<std::uint32_t> index_, link_, parents_;
    std::vector<char> inside_;
};

}  // namespace certa::implicit
