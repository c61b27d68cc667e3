#pragma once
// One reader and one writer per format, from and to memory. Readers throw IoError with `name` and the line; writers
// are given documents that `check_writable` (capabilities.h) has let through.
#include <certa/io.h>

#include <string>
#include <string_view>

namespace certa::io {

MeshDocument read_off(std::string_view text, const std::string& name);
MeshDocument read_obj(std::string_view text, const std::string& name);
MeshDocument read_ply(std::string_view text, const std::string& name);
MeshDocument read_stl(std::string_view text, const std::string& name);
MeshDocument read_medit(std::string_view text, const std::string& name);
MeshDocument read_vtu(std::string_view text, const std::string& name);
MeshDocument read_msh(std::string_view text, const std::string& name);

/// A named text in memory; an absent one has no name.
struct NamedText {
    std::string name;
    std::string_view text;
    bool present() const { return !name.empty(); }
};

/// TetGen's files. `nodes` holds the points of a .poly or .smesh that lists none itself.
MeshDocument read_poly(const NamedText& poly, const NamedText& nodes);
MeshDocument read_smesh(const NamedText& smesh, const NamedText& nodes);
/// Does a .poly or .smesh text leave its points to the .node file beside it?
bool has_points_elsewhere(const NamedText& poly);
struct NodeSetText {
    NamedText node, ele, face, edge;
};
MeshDocument read_node_set(const NodeSetText& set);

std::string write_off(const MeshDocument& document);
std::string write_obj(const MeshDocument& document);
std::string write_ply(const MeshDocument& document, Encoding encoding);
std::string write_stl(const MeshDocument& document, Encoding encoding);
std::string write_poly(const MeshDocument& document);
std::string write_smesh(const MeshDocument& document);
std::string write_medit(const MeshDocument& document);
std::string write_vtu(const MeshDocument& document, Encoding encoding);
std::string write_msh(const MeshDocument& document, Encoding encoding, bool version_2);
std::string write_csv(const MeshDocument& document);

/// The texts of x.node, x.ele, x.face and x.edge.
struct NodeSet {
    std::string node, ele, face, edge;
};
NodeSet write_node_set(const MeshDocument& document);

}  // namespace certa::io
