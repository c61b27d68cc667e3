#pragma once
// Reading and writing mesh files: one reader and one writer per format (docs/formats.md).
#include <certa/error.h>
#include <certa/mesh.h>

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace certa {

/// Formats of files (docs/formats.md).
enum class Format : unsigned char { off, obj, ply, stl, poly, smesh, node, medit, vtu, msh, csv };
/// How numbers are written, where a format knows both; automatic: the format's usual one (docs/formats.md).
enum class Encoding : unsigned char { automatic, ascii, binary };

/// The format that a file name's extension stands for, if any.
std::optional<Format> format_of(std::string_view path);
/// The name as it is written here.
const char* name_of(Format format);
/// The format of that name, if any: the inverse of name_of.
std::optional<Format> format_named(std::string_view name);

/// How a file is read.
struct ReadOptions {
    std::optional<Format> format = std::nullopt;  ///< by extension, else by content, when empty; needed for "-"
};
/// How a file is written.
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
/// Guarantee: every number reads back as the same double; the file appears whole or not at all.
/// Errors:    IoError, also when the format cannot carry something that the document holds (the message names a format
///            that can).
void write_document(const std::string& path, const MeshDocument& document, const WriteOptions& options = {});

///@{
/// Reading from and writing to memory, otherwise as read_document and write_document; `name` stands for the file in
/// error messages.
MeshDocument parse_document(std::string_view text, Format format, const std::string& name = "input");
std::string format_document(const MeshDocument& document, Format format, const WriteOptions& options = {});
///@}

/// Writes a text the way write_document writes a file: complete or not at all. Errors: IoError.
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

/// The polygons of a document that are faces, of three corners or more, in their order: segments and points that facets
/// hold are left out, and what makes several polygons one facet.
///
/// Result: without polygons when there are none.
PolygonMesh make_polygon_mesh(const MeshDocument& document);

/// The triangles of a document, triangle i being polygon i.
///
/// Errors: IoError that names the first polygon that is no triangle, as make_tet_mesh.
TriangleMesh make_triangle_mesh(const MeshDocument& document);

/// The same triangles as polygons.
PolygonMesh make_polygon_mesh(const TriangleMesh& mesh);

}  // namespace certa
