#pragma once
// The checker's reading of certificates of implicit surfaces.
#include <array>
#include <cstdint>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace certa::verify {

/// A certificate that cannot be read.
class UnreadableCertificate : public std::runtime_error {
public:
    using std::runtime_error::runtime_error;
};

struct ImplicitCertificate {
    std::string function, octree;
    std::string mesh;  ///< digest; empty: for any mesh that it proves
    std::array<std::int64_t, 3> first{}, count{}, exponent{};
    std::int64_t resolution = 0;
    std::vector<std::int64_t> negative_points, marks, vertex_edges, genera;
    bool clip = false;                    ///< the surface may meet the box
    std::vector<std::int64_t> loops;      ///< per component, in the order of genera; of a clipped surface only
    std::vector<std::int64_t> hausdorff;  ///< empty, or m and e: a bound m 2^e on the distance
};

/// Of a product: a certificate per factor, whose meshes follow each other in one mesh.
struct ImplicitProductCertificate {
    std::vector<std::int64_t> vertices, triangles;  ///< how many of the mesh belong to each factor
    std::vector<ImplicitCertificate> factors;
};

/// Whether a text begins like the certificate of a product.
bool is_product_certificate(std::string_view text);
/// Errors: as read_certificate.
ImplicitProductCertificate read_product_certificate(std::string_view text);

/// Reads the JSON of docs/formats.md: an object of strings, integers, arrays of integers and one object of such.
/// Errors: UnreadableCertificate, also for keys that are missing, unknown or given twice. `loops` makes a clipped one;
/// `hausdorff` and `mesh` may be missing, too.
ImplicitCertificate read_certificate(std::string_view text);

}  // namespace certa::verify
