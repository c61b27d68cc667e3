// The door of the room: names of formats, files and standard streams, and which reader or writer serves which format.
// Files are read whole: parsing from memory is what makes it fast, lets counts be checked against what is there, and
// gives errors their lines for free.
#include <certa/io.h>
#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>

#include "io/capabilities.h"
#include "io/document_parts.h"
#include "io/formats.h"
#include "io/temporary_file.h"
#include "io/text_cursor.h"

namespace certa {
namespace {

using io::NamedText;

struct Extension {
    std::string_view text;
    Format format;
};
constexpr std::array extensions{
    Extension{".off", Format::off},    Extension{".coff", Format::off},    Extension{".noff", Format::off},
    Extension{".obj", Format::obj},    Extension{".ply", Format::ply},     Extension{".stl", Format::stl},
    Extension{".poly", Format::poly},  Extension{".smesh", Format::smesh}, Extension{".node", Format::node},
    Extension{".ele", Format::node},   Extension{".face", Format::node},   Extension{".edge", Format::node},
    Extension{".mesh", Format::medit}, Extension{".vtu", Format::vtu},     Extension{".msh", Format::msh},
    Extension{".csv", Format::csv},
};

[[noreturn]] void fail(const std::string& path, const char* doing) {
    throw IoError(path, 0, std::string(doing) + ": " + std::strerror(errno));
}

/// Closes a descriptor at the end of a scope; leaves standard input open.
struct Descriptor {
    int number;
    ~Descriptor() {
        if (number > 0) ::close(number);
    }
};

std::string read_stream(int descriptor, std::size_t expected, const std::string& name) {
    std::string content;
    std::size_t size = 0;
    content.resize(expected + 1);
    for (;;) {
        if (size == content.size()) content.resize(content.size() * 2 + 65536);
        const ssize_t got = ::read(descriptor, content.data() + size, content.size() - size);
        if (got < 0 && errno == EINTR) continue;
        if (got < 0) fail(name, "cannot read");
        if (got == 0) break;
        size += static_cast<std::size_t>(got);
    }
    content.resize(size);
    return content;
}

std::string read_whole(const std::string& path) {
    const Descriptor file{::open(path.c_str(), O_RDONLY | O_CLOEXEC)};
    if (file.number < 0) fail(path, "cannot open");
    struct stat status {};
    if (::fstat(file.number, &status) != 0) fail(path, "cannot read");
    if (S_ISDIR(status.st_mode)) throw IoError(path, 0, "is a folder");
    return read_stream(file.number, S_ISREG(status.st_mode) ? static_cast<std::size_t>(status.st_size) : 0, path);
}

bool exists(const std::string& path) { return ::access(path.c_str(), F_OK) == 0; }

/// The path without the extension of a TetGen file, if it has one.
std::string stem_of(const std::string& path) {
    for (const std::string_view extension : {".node", ".ele", ".face", ".edge", ".poly", ".smesh"})
        if (path.size() > extension.size() && path.ends_with(extension))
            return path.substr(0, path.size() - extension.size());
    return path;
}

/// A file that may be missing.
struct OptionalFile {
    explicit OptionalFile(const std::string& path) {
        if (!exists(path)) return;
        name = path;
        content = read_whole(path);
    }
    NamedText text() const { return {name, content}; }
    std::string name, content;
};

MeshDocument read_node_files(const std::string& path) {
    const std::string stem = stem_of(path);
    const bool is_other = stem != path && !path.ends_with(".node");
    const std::string node_path = is_other || exists(stem + ".node") ? stem + ".node" : path;
    const std::string node = read_whole(node_path);
    const OptionalFile ele(stem + ".ele"), face(stem + ".face"), edge(stem + ".edge");
    return io::read_node_set({{node_path, node}, ele.text(), face.text(), edge.text()});
}

MeshDocument parse(const NamedText& file, const NamedText& nodes, Format format) {
    switch (format) {
        case Format::off:
            return io::read_off(file.text, file.name);
        case Format::obj:
            return io::read_obj(file.text, file.name);
        case Format::ply:
            return io::read_ply(file.text, file.name);
        case Format::stl:
            return io::read_stl(file.text, file.name);
        case Format::poly:
            return io::read_poly(file, nodes);
        case Format::smesh:
            return io::read_smesh(file, nodes);
        case Format::node:
            return io::read_node_set({file, {}, {}, {}});
        case Format::medit:
            return io::read_medit(file.text, file.name);
        case Format::vtu:
            return io::read_vtu(file.text, file.name);
        case Format::msh:
            return io::read_msh(file.text, file.name);
        case Format::csv:
            break;
    }
    throw IoError(file.name, 0, "CSV holds fields without a mesh and is only written");
}

/// What the first bytes say; TetGen's formats cannot be told apart by them.
std::optional<Format> format_of_content(std::string_view text) {
    if (text.starts_with("\xEF\xBB\xBF")) text.remove_prefix(3);
    if (text.starts_with("ply\n") || text.starts_with("ply\r")) return Format::ply;
    if (text.starts_with("$MeshFormat")) return Format::msh;
    if (text.starts_with("<?xml") || text.starts_with("<VTKFile")) return Format::vtu;
    if (text.starts_with("solid ") || text.starts_with("solid\n") || text.starts_with("solid\r")) return Format::stl;
    if (text.size() >= 84) {
        std::uint32_t triangles = 0;
        for (int k = 3; k >= 0; --k) triangles = triangles << 8 | static_cast<unsigned char>(text[80 + k]);
        if (text.size() == 84 + std::size_t{50} * triangles) return Format::stl;
    }
    const auto from = [&](std::size_t at) { return text.substr(std::min(at, text.size())); };
    std::string_view rest = text;
    while (!rest.empty() && (rest.front() == '#' || rest.front() == '\n' || rest.front() == '\r')) {
        const std::size_t end = rest.find_first_of("\r\n");
        rest = end == std::string_view::npos ? from(text.size()) : rest.substr(end + 1);
    }
    const std::string_view word = rest.substr(0, rest.find_first_of(" \t\r\n#"));
    if (word == "MeshVersionFormatted") return Format::medit;
    if (word.size() <= 7 && word.ends_with("OFF")) return Format::off;
    for (const std::string_view keyword : {"v", "vn", "vt", "f", "g", "o", "mtllib", "usemtl"})
        if (word == keyword) return Format::obj;
    return std::nullopt;
}

void add_hint(const NamedText& file, Format tried, const IoError& error) {
    const std::optional<Format> looks = format_of_content(file.text);
    if (!looks || *looks == tried) return;
    throw IoError(error.path(), error.line(),
                  error.reason() + " (the content looks like " + name_of(*looks) + ", not " + name_of(tried) + ")");
}

MeshDocument parse_file(const std::string& path, const std::string& name, const std::string& content,
                        std::optional<Format> format) {
    if (!format) format = format_of_content(content);
    if (!format)
        throw IoError(name, 0, "the format cannot be told from the name or the content; give it (--input-format)");
    const NamedText file{name, content};
    try {
        const bool with_nodes = (format == Format::poly || format == Format::smesh) && io::has_points_elsewhere(file);
        const OptionalFile nodes(with_nodes && path != "-" ? stem_of(path) + ".node" : "");
        MeshDocument document = parse(file, nodes.text(), *format);
        io::check_consistent(document, name);
        return document;
    } catch (const IoError& error) {
        add_hint(file, *format, error);
        throw;
    }
}

std::string format_single(const MeshDocument& document, Format format, const WriteOptions& options) {
    switch (format) {
        case Format::off:
            return io::write_off(document);
        case Format::obj:
            return io::write_obj(document);
        case Format::ply:
            return io::write_ply(document, options.encoding);
        case Format::stl:
            return io::write_stl(document, options.encoding);
        case Format::poly:
            return io::write_poly(document);
        case Format::smesh:
            return io::write_smesh(document);
        case Format::node:
            return io::write_node_set(document).node;
        case Format::medit:
            return io::write_medit(document);
        case Format::vtu:
            return io::write_vtu(document, options.encoding);
        case Format::msh:
            return io::write_msh(document, options.encoding, options.msh_version_2);
        case Format::csv:
            return io::write_csv(document);
    }
    return {};
}

bool needs_node_set(const MeshDocument& document) {
    return document.complex.polygon_count() + document.complex.segments.size() + document.tetrahedra.size() > 0;
}

std::string checked_format(const MeshDocument& document, Format format, const WriteOptions& options,
                           const std::string& name) {
    io::check_consistent(document, name);
    io::check_writable(document, format, options, name);
    return format_single(document, format, options);
}

/// x.node with x.ele, x.face and x.edge where there is something to say, or something old to overwrite.
void write_node_files(const std::string& path, const MeshDocument& document, const WriteOptions& options) {
    io::check_consistent(document, path);
    io::check_writable(document, Format::node, options, path);
    const std::string stem = stem_of(path);
    const io::NodeSet set = io::write_node_set(document);
    std::vector<io::FileContent> files{{stem + ".node", set.node}};
    const auto add = [&](const char* extension, bool filled, const std::string& content) {
        const std::string name = stem + extension;
        if (filled || exists(name)) files.push_back({name, content});
    };
    add(".ele", !document.tetrahedra.empty(), set.ele);
    add(".face", document.complex.polygon_count() > 0, set.face);
    add(".edge", !document.complex.segments.empty(), set.edge);
    io::write_files(files);
}

void write_standard_output(std::string_view content) {
    while (!content.empty()) {
        const ssize_t written = ::write(STDOUT_FILENO, content.data(), content.size());
        if (written < 0 && errno == EINTR) continue;
        if (written < 0) fail("standard output", "cannot write");
        content.remove_prefix(static_cast<std::size_t>(written));
    }
}

}  // namespace

std::optional<Format> format_of(std::string_view path) {
    for (const Extension& extension : extensions)
        if (path.size() > extension.text.size() &&
            io::equal_ignoring_case(path.substr(path.size() - extension.text.size()), extension.text))
            return extension.format;
    return std::nullopt;
}

const char* name_of(Format format) {
    constexpr std::array names{"off", "obj", "ply", "stl", "poly", "smesh", "node", "medit", "vtu", "msh", "csv"};
    return names.at(static_cast<std::size_t>(format));
}

std::optional<Format> format_named(std::string_view name) {
    for (unsigned char i = 0; i <= static_cast<unsigned char>(Format::csv); ++i)
        if (name == name_of(static_cast<Format>(i))) return static_cast<Format>(i);
    return std::nullopt;
}

MeshDocument read_document(const std::string& path, const ReadOptions& options) {
    const std::optional<Format> format = options.format ? options.format : format_of(path);
    if (path == "-") {
        const std::string content = read_stream(STDIN_FILENO, 0, "standard input");
        return parse_file(path, "standard input", content, format);
    }
    if (format == Format::node) {
        MeshDocument document = read_node_files(path);
        io::check_consistent(document, path);
        return document;
    }
    const std::string content = read_whole(path);
    return parse_file(path, path, content, format);
}

MeshDocument parse_document(std::string_view text, Format format, const std::string& name) {
    const NamedText file{name, text};
    MeshDocument document = parse(file, {}, format);
    io::check_consistent(document, name);
    return document;
}

void write_document(const std::string& path, const MeshDocument& document, const WriteOptions& options) {
    const std::optional<Format> format = options.format ? options.format : format_of(path);
    if (!format)
        throw IoError(path, 0,
                      path == "-" ? "standard output needs a format (--output-format)"
                                  : "the format cannot be told from the name; give it (--output-format)");
    if (path == "-") {
        write_standard_output(format_document(document, *format, options));
    } else if (*format == Format::node) {
        write_node_files(path, document, options);
    } else {
        const std::string content = checked_format(document, *format, options, path);
        io::write_files({{path, content}});
    }
}

std::string format_document(const MeshDocument& document, Format format, const WriteOptions& options) {
    if (format == Format::node && needs_node_set(document))
        throw IoError("standard output", 0,
                      "a mesh in TetGen's format is several files; write it to a file, or as medit");
    return checked_format(document, format, options, "document");
}

}  // namespace certa
