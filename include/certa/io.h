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
std::optional<Format> format_named(std::string_view name);  ///< inverse of name_of

struct ReadOptions {
    std::optional<Format> format = std::nullopt;  ///< by extension, else by content, when empty; needed for "-"
};
struct WriteOptions {
    std::optional<Format> format = std::nullopt;
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

/// Writes a text the way write_document writes a file: complete or not at all.
void write_text(const std::string& path, std::string_view text);

/// Removes the temporary files of writes in progress. Async-signal-safe: for handlers that end the process.
void remove_temporary_files() noexcept;

/// The document of a conforming mesh: tetrahedra, constraint triangles (polygons) and constraint edges (segments).
///
/// Result: integer fields "region" of tetrahedra, "facet" of polygons and "segment" of segments (1-based, 0: none);
///         markers of the complex's points, facets and segments on what lies on them (segments beyond the given ones
///         have none); "source_kind" (0 input, 1 segment, 2 facet) and "source_index" (1-based) of vertices;
///         "region_attribute" of tetrahedra where any is not 0. `reference` selects what formats with one number per
///         element carry. Arrays that the mesh does not have are left out.
/// Errors: InputError index_out_of_range for labels beyond the complex.
MeshDocument make_document(const TetMesh& mesh, const PiecewiseLinearComplex& complex, Reference reference,
                           const std::vector<double>& region_attributes = {});

/// The mesh that a volume file describes: the inverse of make_document for the labels that the file carries.
///
/// Input:  polygons must be triangles. Labels come from the named fields, else from the one number per element
///         ("references": markers); what is not positive is no label (no_index; region 0).
/// Errors: IoError that names the first polygon that is no triangle, or a label beyond 32 bits.
TetMesh make_tet_mesh(const MeshDocument& document);

}  // namespace certa
