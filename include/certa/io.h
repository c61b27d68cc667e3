#pragma once
// Reading and writing mesh files: one reader and one writer per format (docs/formats.md).
#include <certa/error.h>
#include <certa/mesh.h>

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace certa {

enum class Format : unsigned char { off, obj, ply, stl, poly, smesh, node, medit, vtu, msh, csv };
enum class Encoding : unsigned char { automatic, ascii, binary };

/// The format that a file name's extension stands for, if any.
std::optional<Format> format_of(std::string_view path);
const char* name_of(Format format);

struct ReadOptions {
    std::optional<Format> format;  ///< by extension, else by content, when empty; needed for "-"
};
struct WriteOptions {
    std::optional<Format> format;
    Encoding encoding = Encoding::automatic;
    bool msh_version_2 = false;  ///< write .msh 2.2 instead of 4.1
};

/// Reads a file ("-": standard input) strictly: numbers arrive as the nearest doubles, order is kept.
///
/// Errors: IoError with path, line and reason.
MeshDocument read_document(const std::string& path, const ReadOptions& options = {});

/// Writes a file ("-": standard output) under a temporary name and renames it when complete.
///
/// Every number reads back as the same double. Errors: IoError, also when the format cannot carry something that the
/// document holds (the message names a format that can).
void write_document(const std::string& path, const MeshDocument& document, const WriteOptions& options = {});

/// Reading from and writing to memory; `name` stands for the file in error messages.
MeshDocument parse_document(std::string_view text, Format format, const std::string& name = "input");
std::string format_document(const MeshDocument& document, Format format, const WriteOptions& options = {});

/// Which numbers a volume file carries as the one "reference" of each element.
enum class Reference : unsigned char { id, marker };

/// The document of a conforming mesh: tetrahedra with region, constraint triangles with facet, constraint edges with
/// segment (1-based), named arrays "region", "facet", "segment", and "marker" of `complex`; field "marker" on each kind
/// is what `reference` selects for formats that carry a single number.
MeshDocument make_document(const TetMesh& mesh, const PiecewiseLinearComplex& complex, Reference reference,
                           const std::vector<double>& region_attributes = {});

/// The mesh that a volume file describes: the inverse of make_document for the labels that the file carries.
TetMesh make_tet_mesh(const MeshDocument& document);

}  // namespace certa
