#pragma once
// Distance to the nearest line of a family, at every wedge near one (remesh, stage 6).
#include "remeshing/network.h"

namespace certa::remeshing {

/// A piece of a line, or a feature edge that takes the place of one.
struct Segment {
    Point3 a, b;
    Index line = no_index;
    Index previous = no_index, next = no_index;
};

class Proximity {
public:
    /// Distances are known up to `reach` times the spacing.
    Proximity(const WorkMesh& mesh, const std::vector<double>& spacing, double reach)
        : mesh_(mesh),
          spacing_(spacing),
          reach_(reach),
          distances_(spacing.size(), 1e300),
          sources_(spacing.size(), no_index) {}

    /// Adds a segment of a face behind the last one of the same line (previous: its number or no_index). Its number.
    Index add(const Segment& segment, Index face, Index previous);
    /// Carries what was added to the wedges around.
    void spread();
    /// Distance from a point in a face to the nearest segment that the face's corners know.
    double distance_from(const Point3& point, Index face) const;
    double at(Index wedge) const { return distances_[wedge]; }
    double relative(Index wedge) const { return distances_[wedge] / spacing_[wedge]; }
    /// Wedges whose distance changed in the last spread(), nearest first.
    const std::vector<Index>& changed() const { return changed_; }
    const Segment& segment(Index s) const { return segments_[s]; }

private:
    double descend(const Point3& point, Index& segment) const;
    bool offer(Index wedge, Index segment);

    const WorkMesh& mesh_;
    const std::vector<double>& spacing_;
    double reach_;
    std::vector<double> distances_;
    std::vector<Index> sources_;
    std::vector<Segment> segments_;
    std::vector<std::pair<double, Index>> heap_;
    std::vector<Index> changed_;
};

}  // namespace certa::remeshing
