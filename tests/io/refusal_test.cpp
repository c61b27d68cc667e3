// Every refusal of a reader, with the line that it names and the words that say why; and every refusal of a writer,
// with the format that it offers instead.
#include "documents.h"

namespace certa::test {
namespace {

struct Case {
    Format format;
    const char* name;
    std::string text;
    std::uint64_t line;
    const char* reason;
};

// GoogleTest looks for this name. NOLINTNEXTLINE(readability-identifier-naming)
void PrintTo(const Case& test, std::ostream* out) { *out << name_of(test.format) << ": " << test.name; }

class ReaderRefusal : public testing::TestWithParam<Case> {};

TEST_P(ReaderRefusal, NamesTheLineAndTheReason) {
    const Case& test = GetParam();
    const IoError error = refusal(test.text, test.format);
    EXPECT_EQ(error.path(), "file");
    EXPECT_EQ(error.line(), test.line) << error.what();
    EXPECT_NE(error.reason().find(test.reason), std::string::npos) << error.what();
}

/// A file of one triangle whose last vertex line is `line`.
std::string off(const std::string& line) { return "OFF\n3 1 0\n0 0 0\n1 0 0\n" + line + "\n3 0 1 2\n"; }

const std::string ply_header =
    "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
    "element face 1\nproperty list uchar int vertex_indices\nend_header\n";
const std::string ply_vertices = "0 0 0\n1 0 0\n0 1 0\n";

const std::string node = "3 3 0 0\n1 0 0 0\n2 1 0 0\n3 0 1 0\n";
const std::string medit = "MeshVersionFormatted 2\nDimension 3\nVertices\n3\n0 0 0 0\n1 0 0 0\n0 1 0 0\n";
const std::string msh4 = "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n";
const std::string msh4_nodes = "$Nodes\n1 3 1 3\n2 1 0 3\n1\n2\n3\n0 0 0\n1 0 0\n0 1 0\n$EndNodes\n";
const std::string msh2 = "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n3\n1 0 0 0\n2 1 0 0\n3 0 1 0\n$EndNodes\n";

std::string vtu(const std::string& points, const std::string& connectivity, const std::string& types,
                const std::string& more = "") {
    return "<VTKFile type=\"UnstructuredGrid\">\n<UnstructuredGrid>\n<Piece NumberOfPoints=\"3\" NumberOfCells=\"1\">\n"
           "<Points>\n<DataArray type=\"Float64\" NumberOfComponents=\"3\" format=\"ascii\">\n" +
           points +
           "\n</DataArray>\n</Points>\n<Cells>\n<DataArray type=\"Int32\" Name=\"connectivity\" format=\"ascii\">" +
           connectivity +
           "</DataArray>\n<DataArray type=\"Int32\" Name=\"offsets\" format=\"ascii\">3</DataArray>\n"
           "<DataArray type=\"UInt8\" Name=\"types\" format=\"ascii\">" +
           types + "</DataArray>\n</Cells>\n" + more + "</Piece>\n</UnstructuredGrid>\n</VTKFile>\n";
}
const std::string vtu_points = "0 0 0\n1 0 0\n0 1 0";

std::vector<Case> number_cases() {
    return {
        {Format::off, "nan", off("nan 0 0"), 5, "finite"},
        {Format::off, "inf", off("0 -inf 0"), 5, "finite"},
        {Format::off, "NaN", off("0 0 NaN"), 5, "finite"},
        {Format::off, "overflow", off("0 1e309 0"), 5, "beyond the range"},
        {Format::off, "negative overflow", off("0 -1e99999999999999999999 0"), 5, "beyond the range"},
        {Format::off, "decimal comma", off("0,5 1,5 0"), 5, "decimal point"},
        {Format::off, "comma separated", off("0, 1, 0"), 5, "decimal point"},
        {Format::off, "word", off("0 zero 0"), 5, "'zero'"},
        {Format::off, "trailing letters", off("0 1.5f 0"), 5, "'1.5f'"},
        {Format::off, "hexadecimal", off("0 0x10 0"), 5, "'0x10'"},
        {Format::off, "two signs", off("0 +-1 0"), 5, "'+-1'"},
        {Format::off, "Fortran", off("0 1.0D+00 0"), 5, "1.0D+00"},
        {Format::off, "unprintable", off("0 \x01\xff 0"), 5, "'\?\?'"},
        {Format::off, "too few numbers", off("0 1"), 7, "ends"},
        {Format::ply, "nan", ply_header + "0 0 0\n1 0 0\n0 nan 0\n3 0 1 2\n", 12, "finite"},
        {Format::ply, "decimal comma", ply_header + "0 0 0\n1 0 0\n0 1,5 0\n3 0 1 2\n", 12, "decimal point"},
        {Format::obj, "nan", "v 0 0 0\nv nan 0 0\n", 2, "finite"},
        {Format::obj, "decimal comma", "v 0 0 0\n\nv 0 1,5 0\n", 3, "decimal point"},
        {Format::stl, "nan", "solid\nfacet normal 0 0 1\nouter loop\nvertex 0 0 nan\n", 4, "finite"},
        {Format::poly, "nan", "2 3\n1 0 0 0\n2 0 0 nan\n", 3, "finite"},
        {Format::medit, "nan", "MeshVersionFormatted 2\nDimension 3\nVertices 1\n0 nan 0 0\n", 4, "finite"},
        {Format::msh, "nan", "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n1\n1 0 0 nan\n", 6, "finite"},
        {Format::vtu, "nan", vtu("0 0 0\n1 nan 0\n0 1 0", "0 1 2", "5"), 7, "finite"},
    };
}

std::vector<Case> count_cases() {
    return {
        {Format::off, "empty", "", 1, "empty"},
        {Format::off, "blank", "\n\n  \n", 1, "empty"},
        {Format::off, "counts missing", "OFF\n", 1, "number of vertices"},
        {Format::off, "too many vertices", "OFF\n1000000000 1 0\n0 0 0\n", 2, "bytes follow"},
        {Format::off, "too many faces", "OFF\n3 1000000000 0\n0 0 0\n", 2, "bytes follow"},
        {Format::off, "beyond 32 bits", "OFF\n4294967295 0 0\n", 2, "limit of 4294967294"},
        {Format::off, "beyond 64 bits", "OFF\n99999999999999999999 0 0\n", 2, "'99999999999999999999'"},
        {Format::off, "negative", "OFF\n-3 1 0\n", 2, "negative"},
        {Format::off, "fractional", "OFF\n3.0 1 0\n", 2, "'3.0'"},
        {Format::off, "one face too few", "OFF\n3 2 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n\n", 8, "ends"},
        {Format::off, "one face too many", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n3 0 1 2\n", 7, "after the last"},
        {Format::off, "a vertex of many numbers", off("0 1 0 1 0 0 1 0 1 1 1 1 1"), 5, "at the end of the line"},
        {Format::off, "face of nothing", "OFF\n1 1 0\n0 0 0\n0  \n", 4, "no corners"},
        {Format::off, "keyword", "OOF\n3 1 0\n", 1, "'OOF'"},
        {Format::off, "four dimensions", "4OFF\n3 1 0\n", 1, "three coordinates"},
        {Format::off, "binary", "OFF BINARY\n\1\2\3", 1, "binary"},
        {Format::off, "UTF-16", std::string("\xFF\xFEO\0F\0", 6), 1, "UTF-16"},
        {Format::off, "degree beyond the file", "OFF\n1 1 0\n0 0 0\n900000 0 0\n", 4, "bytes follow"},
        {Format::obj, "empty", "", 1, "empty"},
        {Format::obj, "two coordinates", "v 1 2\nv 1 2 3\n", 1, "fewer than three"},
        {Format::obj, "eight numbers", "v 1 2 3 4 5 6 7 8\n", 1, "after the coordinates"},
        {Format::obj, "face of nothing", "v 1 2 3\nf\n", 2, "without corners"},
        {Format::obj, "line of one", "v 1 2 3\nl 1\n", 2, "fewer than two"},
        {Format::obj, "statement", "v 1 2 3\nw 1\n", 2, "'w'"},
        {Format::obj, "free form", "v 1 2 3\n\ncurv 0 1 1 1\n", 3, "free-form"},
        {Format::obj, "after a backslash", "v 1 2 \\ 3\n", 1, "backslash"},
        {Format::ply, "empty", "", 1, "empty"},
        {Format::ply, "magic", "plyx\n", 1, "word ply"},
        {Format::ply, "format missing", "ply\nelement vertex 0\nend_header\n", 3, "format"},
        {Format::ply, "format", "ply\nformat ascii 2.0\n", 2, "version"},
        {Format::ply, "header unfinished", "ply\nformat ascii 1.0\nelement vertex 3\n", 4, "end_header"},
        {Format::ply, "type", "ply\nformat ascii 1.0\nelement vertex 3\nproperty real x\n", 4, "'real'"},
        {Format::ply, "property twice", "ply\nformat ascii 1.0\nelement vertex 3\nproperty int x\nproperty int x\n", 5,
         "twice"},
        {Format::ply, "element twice", "ply\nformat ascii 1.0\nelement vertex 3\nelement vertex 3\n", 4, "twice"},
        {Format::ply, "property of nothing", "ply\nformat ascii 1.0\nproperty int x\n", 3, "before the first"},
        {Format::ply, "list counted by floats", "ply\nformat ascii 1.0\nelement face 1\nproperty list float int x\n", 4,
         "floating"},
        {Format::ply, "no coordinates", "ply\nformat ascii 1.0\nelement vertex 0\nproperty int x\nend_header\n", 5,
         "lacks"},
        {Format::ply, "too many rows", "ply\nformat ascii 1.0\nelement vertex 999\nproperty float x\nend_header\n0\n",
         5, "promises"},
        {Format::ply, "row too short", ply_header + "0 0 0\n1 0\n0 1 0\n3 0 1 2\n", 11, "line ends"},
        {Format::ply, "row too long", ply_header + "0 0 0\n1 0 0 7\n0 1 0\n3 0 1 2\n", 11, "'7'"},
        {Format::ply, "row too many", ply_header + ply_vertices + "3 0 1 2\n3 0 1 2\n", 14, "after the last"},
        {Format::ply, "truncated", ply_header + ply_vertices, 12, "promises"},
        {Format::ply, "beyond uchar", ply_header + ply_vertices + "300 0 1 2\n", 13, "beyond the type"},
        {Format::ply, "list too long", ply_header + ply_vertices + "200 0 1 2\n", 13, "does not fit"},
        {Format::ply, "face of nothing", ply_header + ply_vertices + "0\n", 13, "without corners"},
        {Format::stl, "empty", "", 1, "empty"},
        {Format::stl, "keyword", "cube\n", 1, "solid"},
        {Format::stl, "endless", "solid x\n", 2, "ends"},
        {Format::stl, "loop", "solid x\nfacet normal 0 0 0\nouter hoop\n", 3, "'loop'"},
        {Format::stl, "quadrilateral",
         "solid\nfacet normal 0 0 0\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 1 1 0\nvertex 0 1 0\n", 7,
         "'endloop'"},
        {Format::stl, "second solid", "solid x\nendsolid x\nfacet\n", 3, "'solid'"},
    };
}

std::vector<Case> index_cases() {
    const std::string range = "out of range";
    return {
        {Format::off, "index", "OFF\n2 1 0\n0 0 0\n1 0 0\n3 0 1 2\n", 5, "out of range"},
        {Format::off, "negative index", "OFF\n2 1 0\n0 0 0\n1 0 0\n3 0 1 -1\n", 5, "out of range"},
        {Format::off, "index on a later line", "OFF\n2 1 0\n0 0 0\n1 0 0\n3 0\n1\n9\n", 7, "out of range"},
        {Format::off, "index into nothing", "OFF\n0 1 0\n3 0 0 0\n", 3, "there is none"},
        {Format::off, "fractional index", "OFF\n2 1 0\n0 0 0\n1 0 0\n3 0 1 1.5\n", 5, "'1.5'"},
        {Format::obj, "index", "v 0 0 0\nf 1 1 2\nv 0 0 0 # late\nf 1 2 3\n", 4, "out of range"},
        {Format::obj, "zero", "v 0 0 0\nf 1 1 0\n", 2, "out of range"},
        {Format::obj, "too negative", "v 0 0 0\nf -1 -1 -2\n", 2, "out of range"},
        {Format::obj, "huge", "v 0 0 0\nf 1 1 4294967296\n", 2, "out of range"},
        {Format::obj, "corner", "v 0 0 0\nf 1 1 x\n", 2, "'x'"},
        {Format::obj, "slashes", "v 0 0 0\nf 1 1 1/2/3/4\n", 2, "'1/2/3/4'"},
        {Format::ply, "index", ply_header + ply_vertices + "3 0 1 3\n", 13, "out of range"},
        {Format::ply, "index before its vertices",
         "ply\nformat ascii 1.0\nelement face 2\nproperty list uchar int vertex_index\nelement vertex 1\nproperty "
         "float x\n"
         "property float y\nproperty float z\nend_header\n3 0 0 0\n3 0 0 -1\n0 0 0\n",
         11, "out of range"},
        {Format::poly, "index", node + "1 0\n1\n3 1 2 4\n0\n", 7, "out of range"},
        {Format::poly, "index below the base", node + "1 0\n1\n3 0 1 2\n0\n", 7, "out of range"},
        {Format::smesh, "index", node + "1 0\n3 1 2 4\n0\n", 6, "out of range"},
        {Format::medit, "index", medit + "Triangles\n1\n1 2 4 0\n", 10, "out of range"},
        {Format::medit, "zero", medit + "Triangles\n1\n0 1 2 0\n", 10, "out of range"},
        {Format::medit, "index before the vertices",
         "MeshVersionFormatted 2\nEdges 2\n1 1 0\n1 2 0\nVertices\n1\n0 0 0 0\n", 4, "out of range"},
        {Format::msh, "node", msh2 + "$Elements\n1\n1 2 2 0 1 1 2 4\n$EndElements\n", 12, "node 4"},
        {Format::msh, "node of 4.1", msh4 + msh4_nodes + "$Elements\n1 1 1 1\n2 1 2 1\n1 1 2 4\n$EndElements\n", 17,
         "node 4"},
        {Format::vtu, "point", vtu(vtu_points, "0 1 3", "5"), 12, "out of range"},
        {Format::vtu, "negative point", vtu(vtu_points, "0 1 -1", "5"), 12, "out of range"},
    };
}

std::vector<Case> tetgen_cases() {
    return {
        {Format::poly, "empty", "# nothing\n", 1, "empty"},
        {Format::poly, "points elsewhere", "0 3 0 0\n", 1, ".node file"},
        {Format::poly, "two dimensions", "1 2 0 0\n1 0 0 0\n", 1, "dimension is 2"},
        {Format::poly, "lying count", "3000 3 0 0\n1 0 0 0\n", 1, "bytes follow"},
        {Format::poly, "lying attributes", "1 3 1000 0\n1 0 0 0\n", 1, "promises"},
        {Format::poly, "marker flag", "1 3 0 2\n1 0 0 0\n", 1, "not 0 or 1"},
        {Format::poly, "base of two", "1 3 0 0\n2 0 0 0\n", 2, "0 or 1"},
        {Format::poly, "lost row", "2 3 0 0\n1 0 0 0\n3 0 0 0\n", 3, "2 was expected"},
        {Format::poly, "extra column", "2 3 0 0\n1 0 0 0 5\n2 0 0 0\n", 2, "'5'"},
        {Format::poly, "facet of nothing", node + "1 0\n0\n", 6, "without polygons"},
        {Format::poly, "polygon of nothing", node + "1 0\n1\n0 1\n", 7, "without corners"},
        {Format::poly, "marker without flag", node + "1 0\n1 0 7\n3 1 2 3\n0\n", 6, "'7'"},
        {Format::poly, "facet missing", node + "2 0\n1\n3 1 2 3\n", 8, "ends"},
        {Format::poly, "hole", node + "0 0\n1\n1 0 0\n", 8, "ends"},
        {Format::poly, "rest", node + "0 0\n0\n0\nfoo\n", 8, "'foo'"},
        {Format::poly, "marker beyond 32 bits", node + "1 1\n1 0 2147483648\n3 1 2 3\n0\n", 6, "32 bits"},
        {Format::smesh, "truncated", node + "1 0\n3 1 2\n", 7, "ends"},
        {Format::smesh, "extra corner", node + "1 0\n3 1 2 3 1\n0\n", 6, "'1'"},
        {Format::node, "row after the last", node + "4 0 0 0\n", 5, "after the last"},
        {Format::medit, "empty", "", 1, "empty"},
        {Format::medit, "magic", "Vertices\n", 1, "MeshVersionFormatted"},
        {Format::medit, "version", "MeshVersionFormatted 7\n", 1, "version 7"},
        {Format::medit, "two dimensions", "MeshVersionFormatted 2\nDimension 2\n", 2, "dimension is 2"},
        {Format::medit, "lying count", "MeshVersionFormatted 2\nDimension 3\nVertices\n4000000\n0 0 0 0\n", 4,
         "bytes follow"},
        {Format::medit, "no vertices", "MeshVersionFormatted 2\nDimension 3\nEnd\n", 3, "no vertices"},
        {Format::medit, "vertices twice", medit + "Vertices\n", 8, "second list"},
        {Format::medit, "section", medit + "Frobnications 3\n", 8, "'Frobnications'"},
        {Format::medit, "hexahedra", medit + "Hexahedra\n1\n1 1 1 1 1 1 1 1 0\n", 9, "Hexahedra"},
        {Format::medit, "after the end", medit + "End\nTriangles\n", 9, "after End"},
        {Format::medit, "truncated", medit + "Triangles\n1\n1 2 3\n", 11, "ends"},
    };
}

std::vector<Case> msh_cases() {
    return {
        {Format::msh, "empty", "", 1, "empty"},
        {Format::msh, "magic", "$Nodes\n", 1, "$MeshFormat"},
        {Format::msh, "old version", "$MeshFormat\n4 0 8\n", 2, "2.2 or 4.1"},
        {Format::msh, "size of numbers", "$MeshFormat\n2.2 0 4\n", 2, "4 bytes"},
        {Format::msh, "kind", "$MeshFormat\n2.2 3 8\n", 2, "binary"},
        {Format::msh, "unfinished", "$MeshFormat\n2.2 0 8\n$Nodes\n", 3, "$EndMeshFormat"},
        {Format::msh, "no nodes", "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n", 3, "no $Nodes"},
        {Format::msh, "no section", "$MeshFormat\n2.2 0 8\n$EndMeshFormat\nfoo\n", 4, "'foo'"},
        {Format::msh, "open section", "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Foo\n1\n", 4, "no end"},
        {Format::msh, "lying count", "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n70000\n1 0 0 0\n", 5, "do not fit"},
        {Format::msh, "nodes twice", msh2 + "$Nodes\n", 10, "second"},
        {Format::msh, "node twice", "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n2\n1 0 0 0\n1 0 0 0\n", 7, "twice"},
        {Format::msh, "hexahedra", msh2 + "$Elements\n1\n1 5 2 0 1 1 2 3 1 2 3 1 2\n", 12, "type 5"},
        {Format::msh, "element twice", msh2 + "$Elements\n2\n1 1 0 1 2\n1 1 0 1 2\n", 13, "twice"},
        {Format::msh, "element data", msh2 + "$ElementData\n1\n\"a\"\n0\n3\n0 1 1\n9 1.0\n", 16, "element 9"},
        {Format::msh, "data twice", msh2 + "$NodeData\n1\n\"a\"\n0\n3\n0 1 2\n1 1.0\n1 2.0\n", 17, "two rows"},
        {Format::msh, "data of no name", msh2 + "$NodeData\n0\n0\n3\n0 1 1\n1 1.0\n", 14, "incomplete"},
        {Format::msh, "name without quotes", msh2 + "$NodeData\n1\na\n", 12, "double quotes"},
        {Format::msh, "promised nodes", msh4 + "$Nodes\n1 2 1 2\n2 1 0 1\n1\n0 0 0\n$EndNodes\n", 8, "promised"},
        {Format::msh, "promised elements", msh4 + msh4_nodes + "$Elements\n1 2 1 1\n2 1 2 1\n1 1 2 3\n$EndElements\n",
         17, "promised"},
        {Format::msh, "lying block", msh4 + "$Nodes\n1 3 1 3\n2 1 0 99999\n1\n2\n3\n0 0 0\n1 0 0\n", 6, "do not fit"},
        {Format::msh, "4.1 without nodes", msh4 + "$Elements\n", 4, "before $Nodes"},
    };
}

std::vector<Case> vtu_cases() {
    const std::string root = "<VTKFile type=\"UnstructuredGrid\">\n<UnstructuredGrid>\n";
    return {
        {Format::vtu, "poly data", "<VTKFile type=\"PolyData\">\n", 1, "UnstructuredGrid"},
        {Format::vtu, "no root", "<Foo>\n", 1, "VTKFile"},
        {Format::vtu, "empty", "", 1, "no UnstructuredGrid"},
        {Format::vtu, "open", root, 3, "within the tag"},
        {Format::vtu, "crossed", root + "<Piece NumberOfPoints='0' NumberOfCells='0'>\n</UnstructuredGrid>", 4,
         "closes 'Piece'"},
        {Format::vtu, "quote", "<VTKFile type=UnstructuredGrid>\n", 1, "not quoted"},
        {Format::vtu, "comment", "<VTKFile type=\"UnstructuredGrid\">\n<!-- \n", 2, "never closed"},
        {Format::vtu, "pieces", root + "<Piece NumberOfPoints='0' NumberOfCells='0'/>\n<Piece/>\n", 4,
         "several pieces"},
        {Format::vtu, "count", root + "<Piece NumberOfPoints='many' NumberOfCells='0'/>\n", 3, "NumberOfPoints"},
        {Format::vtu, "too many", root + "<Piece NumberOfPoints='4294967295' NumberOfCells='0'/>\n", 3, "4294967294"},
        {Format::vtu, "byte order", "<VTKFile type=\"UnstructuredGrid\" byte_order=\"Middle\">\n", 1, "byte_order"},
        {Format::vtu, "header type", "<VTKFile type=\"UnstructuredGrid\" header_type=\"UInt8\">\n", 1, "header_type"},
        {Format::vtu, "compressor", "<VTKFile type=\"UnstructuredGrid\" compressor=\"vtkLZ4DataCompressor\">\n", 1,
         "vtkLZ4"},
        {Format::vtu, "points missing", vtu("0 0 0\n1 0 0\n", "0 1 2", "5"), 5, "6 numbers"},
        {Format::vtu, "corner missing", vtu(vtu_points, "0 1", "5"), 12, "2 numbers"},
        {Format::vtu, "hexahedron", vtu(vtu_points, "0 1 2", "12"), 14, "type 12"},
        {Format::vtu, "tetrahedron of three", vtu(vtu_points, "0 1 2", "10"), 14, "3 corners"},
        {Format::vtu, "data too short",
         vtu(vtu_points, "0 1 2", "5",
             "<PointData>\n<DataArray type=\"Float64\" Name=\"a\" format=\"ascii\">1 2</DataArray>\n</PointData>\n"),
         17, "2 numbers"},
        {Format::vtu, "format",
         vtu(vtu_points, "0 1 2", "5",
             "<PointData>\n<DataArray type=\"Float64\" Name=\"a\" format=\"hex\">1 2</DataArray>\n</PointData>\n"),
         17, "'hex'"},
        {Format::vtu, "base64",
         vtu(vtu_points, "0 1 2", "5",
             "<PointData>\n<DataArray type=\"Float64\" Name=\"a\" format=\"binary\">AAA</DataArray>\n</PointData>\n"),
         17, "base64"},
        {Format::vtu, "lying size",
         vtu(vtu_points, "0 1 2", "5",
             "<PointData>\n<DataArray type=\"Float64\" Name=\"a\" "
             "format=\"binary\">////fw==</DataArray>\n</PointData>\n"),
         17, "beyond the end"},
        {Format::vtu, "no appended data",
         vtu(vtu_points, "0 1 2", "5",
             "<PointData>\n<DataArray type=\"Float64\" Name=\"a\" format=\"appended\" offset=\"0\"/>\n</PointData>\n"),
         17, "no appended data"},
    };
}

INSTANTIATE_TEST_SUITE_P(Numbers, ReaderRefusal, testing::ValuesIn(number_cases()));
INSTANTIATE_TEST_SUITE_P(Counts, ReaderRefusal, testing::ValuesIn(count_cases()));
INSTANTIATE_TEST_SUITE_P(Indices, ReaderRefusal, testing::ValuesIn(index_cases()));
INSTANTIATE_TEST_SUITE_P(TetgenAndMedit, ReaderRefusal, testing::ValuesIn(tetgen_cases()));
INSTANTIATE_TEST_SUITE_P(Msh, ReaderRefusal, testing::ValuesIn(msh_cases()));
INSTANTIATE_TEST_SUITE_P(Vtu, ReaderRefusal, testing::ValuesIn(vtu_cases()));

TEST(ReaderRefusal, CountsLinesOfEveryKindOfLineEnd) {
    for (const char* end : {"\n", "\r\n", "\r"}) {
        std::string text;
        for (const char* line : {"OFF # comment", "3 1 0", "", "0 0 0", "1 0 0", "0 1 0", "3 0 1 3"})
            text += std::string(line) + end;
        EXPECT_EQ(refusal(text, Format::off).line(), 7U);
    }
}

TEST(ReaderRefusal, TruncationAnywhereIsNoticedOrHarmless) {
    // Cut a file of every format at every byte: an error or a document, never a crash; the whole file always reads.
    std::mt19937_64 random(3);
    MeshDocument document;
    add_points(document, 5, random);
    for (int i = 0; i < 3; ++i) add_polygon(document, 3, random);
    for (const Format format : {Format::off, Format::obj, Format::ply, Format::stl, Format::poly, Format::smesh,
                                Format::medit, Format::vtu, Format::msh})
        for (const Encoding encoding : {Encoding::automatic, Encoding::ascii, Encoding::binary}) {
            const bool has_binary = format == Format::ply || format == Format::vtu || format == Format::msh;
            if (encoding == Encoding::binary && !has_binary) continue;
            MeshDocument writable = document;
            // STL has no vertices beside those of its triangles.
            add_facet(writable.complex, {{VertexId{0}, VertexId{1}, VertexId{2}}});
            add_facet(writable.complex, {{VertexId{2}, VertexId{3}, VertexId{4}}});
            const std::string text = format_document(writable, format, {.encoding = encoding});
            EXPECT_NO_THROW(parse_document(text, format)) << name_of(format);
            std::size_t refused = 0;
            for (std::size_t size = 0; size < text.size(); ++size) {
                try {
                    parse_document(text.substr(0, size), format);
                } catch (const IoError&) {
                    ++refused;
                }
            }
            // Only OBJ states no counts; in the others a few last bytes (a line end, an End) may be missing, and the
            // last digits of the last number.
            if (format != Format::obj) {
                EXPECT_GT(refused + 60, text.size()) << name_of(format);
            }
        }
}

MeshDocument triangle() {
    MeshDocument document;
    document.complex.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    add_facet(document.complex, {{VertexId{0}, VertexId{1}, VertexId{2}}});
    return document;
}

std::string refusal_to_write(const MeshDocument& document, Format format, const WriteOptions& options = {}) {
    try {
        format_document(document, format, options);
    } catch (const IoError& error) {
        return error.reason();
    }
    return "written without complaint";
}

void expect_refusal(const MeshDocument& document, Format format, const std::string& what, const std::string& instead) {
    const std::string reason = refusal_to_write(document, format);
    EXPECT_NE(reason.find(what), std::string::npos) << name_of(format) << ": " << reason;
    EXPECT_NE(reason.find(instead), std::string::npos) << name_of(format) << ": " << reason;
}

TEST(WriterRefusal, Structure) {
    MeshDocument with_segment = triangle();
    with_segment.complex.segments.push_back({VertexId{0}, VertexId{1}});
    for (const Format format : {Format::off, Format::stl}) expect_refusal(with_segment, format, "segments", "obj");

    MeshDocument with_tetrahedron = triangle();
    with_tetrahedron.tetrahedra.push_back({VertexId{0}, VertexId{1}, VertexId{2}, VertexId{0}});
    for (const Format format : {Format::off, Format::obj, Format::ply, Format::stl, Format::poly, Format::smesh})
        expect_refusal(with_tetrahedron, format, "tetrahedra", "medit");

    MeshDocument with_hole = triangle();
    add_facet(with_hole.complex, {{VertexId{0}, VertexId{1}, VertexId{2}}}, {{0.1, 0.1, 0}});
    for (const Format format :
         {Format::off, Format::obj, Format::ply, Format::stl, Format::smesh, Format::medit, Format::vtu, Format::msh})
        expect_refusal(with_hole, format, "holes", "can carry it: poly");

    MeshDocument with_seed = triangle();
    with_seed.complex.region_seeds.push_back({{0, 0, 0}, 1, 0});
    expect_refusal(with_seed, Format::off, "region seeds", "poly");

    MeshDocument with_quad = triangle();
    add_facet(with_quad.complex, {{VertexId{0}, VertexId{1}, VertexId{2}, VertexId{0}}});
    expect_refusal(with_quad, Format::stl, "four corners", "off");
    EXPECT_NO_THROW(format_document(with_quad, Format::medit));
    add_facet(with_quad.complex, {{VertexId{0}, VertexId{1}, VertexId{2}}});
    expect_refusal(with_quad, Format::medit, "order", "vtu");

    MeshDocument with_pentagon = triangle();
    add_facet(with_pentagon.complex, {{VertexId{0}, VertexId{1}, VertexId{2}, VertexId{0}, VertexId{1}}});
    for (const Format format : {Format::stl, Format::medit, Format::msh})
        expect_refusal(with_pentagon, format, "more than four", "vtu");

    MeshDocument with_needle = triangle();
    add_facet(with_needle.complex, {{VertexId{0}, VertexId{1}}});
    for (const Format format : {Format::stl, Format::medit, Format::vtu, Format::msh})
        expect_refusal(with_needle, format, "fewer than three", "off");

    MeshDocument with_lone_vertex = triangle();
    with_lone_vertex.complex.positions.push_back({5, 5, 5});
    expect_refusal(with_lone_vertex, Format::stl, "no triangle uses", "off");
}

TEST(WriterRefusal, MarkersAndFields) {
    MeshDocument marked = triangle();
    marked.complex.facet_markers = {7};
    for (const Format format : {Format::off, Format::obj, Format::stl})
        expect_refusal(marked, format, "markers", "poly");

    MeshDocument with_field = triangle();
    with_field.fields.push_back({"mean", Location::vertices, 1, std::vector<double>{1, 2, 3}});
    for (const Format format : {Format::off, Format::obj, Format::stl, Format::poly, Format::medit})
        expect_refusal(with_field, format, "'mean'", "can carry it: ply, vtu");
    MeshDocument with_tensor = triangle();
    with_tensor.fields.push_back({"tensor", Location::vertices, 6, std::vector<double>(18, 1.0)});
    expect_refusal(with_tensor, Format::msh, "'tensor'", "vtu");
    MeshDocument with_wide = triangle();
    with_wide.fields.push_back({"id", Location::vertices, 1, std::vector<std::int64_t>(3, std::int64_t{1} << 40)});
    expect_refusal(with_wide, Format::ply, "'id'", "vtu");
    MeshDocument on_polygons = triangle();
    on_polygons.fields.push_back({"area", Location::polygons, 1, std::vector<double>{1}});
    expect_refusal(on_polygons, Format::csv, "'area'", "vtu");
    expect_refusal(triangle(), Format::csv, "without fields", "off");

    // Two numbers per element, and room for one.
    marked.fields.push_back({"facet", Location::polygons, 1, std::vector<std::int64_t>{1}});
    expect_refusal(marked, Format::medit, "'facet'", "vtu");
    marked.reference = Reference::id;
    EXPECT_NE(format_document(marked, Format::medit).find("1 2 3 1\n"), std::string::npos);
    marked.reference = Reference::marker;
    EXPECT_NE(format_document(marked, Format::medit).find("1 2 3 7\n"), std::string::npos);
}

TEST(WriterRefusal, Encodings) {
    EXPECT_NE(refusal_to_write(triangle(), Format::off, {.encoding = Encoding::binary}).find("text format"),
              std::string::npos);
    EXPECT_NE(refusal_to_write(triangle(), Format::vtu, {.msh_version_2 = true}).find("version"), std::string::npos);
}

TEST(WriterRefusal, InconsistentDocuments) {
    const auto expect = [](const MeshDocument& document, const std::string& what) {
        const std::string reason = refusal_to_write(document, Format::vtu);
        EXPECT_NE(reason.find(what), std::string::npos) << reason;
    };
    MeshDocument document = triangle();
    document.complex.corners[1] = VertexId{3};
    expect(document, "polygon 1 names vertex 4 of 3");
    document = triangle();
    document.complex.polygon_offsets.back() = 4;
    expect(document, "offsets of polygons");
    document = triangle();
    document.complex.facet_offsets.push_back(1);
    expect(document, "holes of facets");
    document = triangle();
    document.complex.facet_markers = {1, 2};
    expect(document, "2 markers for 1 facets");
    document = triangle();
    document.complex.positions[2].y = std::numeric_limits<double>::infinity();
    expect(document, "point 3 is not finite");
    document = triangle();
    document.fields.push_back({"f", Location::vertices, 2, std::vector<double>(3, 0.0)});
    expect(document, "3 numbers instead of 6");
    document.fields[0] = {"f", Location::vertices, 1,
                          std::vector<double>{0, 0, std::numeric_limits<double>::quiet_NaN()}};
    expect(document, "not finite at number 3");
    document.fields[0] = {"f", Location::vertices, 1, std::vector<double>(3, 0.0)};
    document.fields.push_back(document.fields[0]);
    expect(document, "twice");
    document = triangle();
    document.tetrahedra.push_back({VertexId{0}, VertexId{1}, VertexId{2}, VertexId{9}});
    expect(document, "tetrahedron 1 names vertex 10");
    document = triangle();
    add_facet(document.complex, {{}});
    expect(document, "polygon 2 has no corners");
}

}  // namespace
}  // namespace certa::test
