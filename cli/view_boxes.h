#pragma once
// Boxes that `certa implicit` writes as JSON, as a model to look at.
#include <certa/mesh.h>

#include <string>

namespace certa::cli {

/// Whether a file is one that `read_boxes` takes, by its name.
bool holds_boxes(const std::string& path);

/// Reads a certificate or a report of `certa implicit`.
///
/// Result: the box of the problem as segments; the boxes in it as polygons with the fields "box" and, from a
///         certificate, "cluster" and "sign" (of the function on the cluster), from a report "reason" (counted from 1
///         in the order of ImplicitObstacle::Reason). Faces between two boxes of a cluster are left out. A point in
///         each cluster or undecided box has its label too, all other points 0.
/// Errors: IoError for files that hold neither.
MeshDocument read_boxes(const std::string& path);

}  // namespace certa::cli
