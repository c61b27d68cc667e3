#pragma once
// One self-contained page that shows meshes in a browser: surfaces, tetrahedra behind a clipping plane, fields,
// directions, labels. The viewer is in the library; the page needs neither a network nor other files.
#include <certa/mesh.h>

#include <span>
#include <string>

namespace certa {

/// A document under the name that the page shows.
struct ViewModel {
    std::string name;
    MeshDocument document;
    bool is_overlay =
        false;  ///< boxes and the like: shown inside the surface of another model of the page, seen through
};

/// The axis that points upwards in the first view.
enum class UpAxis : unsigned char { y, z };

/// What a page is asked for.
struct ViewOptions {
    std::string title;  ///< of the page; empty: the names of the models
    UpAxis up = UpAxis::z;
};

/// The page (HTML, UTF-8) that shows `models`, with a switch if there are several.
///
/// Input:      any documents that readers return; polygons may be non-planar and may cross, as in files to be mended.
/// Result:     positions are embedded in single precision relative to the model's box, all other numbers exactly;
///             fields of one component can be colours, of three components lines; of others each component can be a
///             colour.
/// Errors:     InputError: empty_input without a model or for a model without points, non_finite_coordinate,
///             index_out_of_range for corners or fields that do not fit.
/// Guarantee:  the same bytes for the same models; the page opens without a network (tested in Chromium).
/// Cost:       linear; about 48 bytes per vertex of a triangle mesh, 22 per tetrahedron, at most 11 per number of a
///             field.
std::string format_view(std::span<const ViewModel> models, const ViewOptions& options = {});

}  // namespace certa
