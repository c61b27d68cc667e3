// The body of every fuzzer, and of the replay of the corpus. Law: a reader refuses (IoError) or returns a document;
// a document that its format can carry survives writing and reading.
// The language of expressions has the same law: what is accepted is formatted and read back to the same text.
// A certificate is refused, or describes an octree from which the checker builds its triangulation.
// A set of TetGen's mesh files is one input: .node, .ele, .face, .edge, separated by lines "%%".
#include "targets.h"

#include <certa/implicit.h>
#include <certa/io.h>

#include <array>
#include <cstdio>
#include <cstdlib>
#include <optional>
#include <string>

#include "io/formats.h"
#include "verify/implicit_certificate.h"
#include "verify/implicit_complex.h"

namespace certa::fuzz {
namespace {

constexpr std::array<std::string_view, 12> names{"off",      "obj",   "ply", "stl", "poly",       "smesh",
                                                 "node_set", "medit", "vtu", "msh", "expression", "certificate"};

constexpr std::string_view separator = "%%\n";

io::NodeSetText split_set(std::string_view bytes) {
    io::NodeSetText set;
    int part = 0;
    for (io::NamedText* text : {&set.node, &set.ele, &set.face, &set.edge}) {
        const std::size_t end = bytes.find(separator);
        *text = {std::string("part ") + static_cast<char>('1' + part++), bytes.substr(0, end)};
        if (end == std::string_view::npos) break;
        bytes.remove_prefix(end + separator.size());
    }
    return set;
}

std::string join_set(const MeshDocument& document) {
    const io::NodeSet set = io::write_node_set(document);
    return set.node + std::string(separator) + set.ele + std::string(separator) + set.face + std::string(separator) +
           set.edge;
}

std::optional<MeshDocument> parse(std::string_view name, std::string_view bytes) {
    try {
        if (name == "node_set") return io::read_node_set(split_set(bytes));
        return parse_document(bytes, format_named(name).value());
    } catch (const IoError&) {
        return std::nullopt;
    }
}

std::optional<std::string> format(std::string_view name, const MeshDocument& document) {
    try {
        if (name == "node_set") return join_set(document);
        // Every field must be checked even if the format is that of the file: .ply may say what .ply cannot.
        return format_document(document, format_named(name).value());
    } catch (const IoError&) {
        return std::nullopt;
    }
}

[[noreturn]] void fail(std::string_view what, std::string_view first, std::string_view second) {
    std::fprintf(stderr, "%.*s\n--- first:\n%.*s\n--- second:\n%.*s\n", static_cast<int>(what.size()), what.data(),
                 static_cast<int>(first.size()), first.data(), static_cast<int>(second.size()), second.data());
    std::abort();
}

void run_expression(std::string_view bytes) {
    std::optional<Expression> function;
    try {
        function = parse_expression(bytes);
    } catch (const ExpressionError&) {
        return;
    }
    const std::string first = format_expression(*function);
    try {
        const std::string second = format_expression(parse_expression(first));
        if (second != first) fail("what was written changes when it is read", first, second);
    } catch (const ExpressionError& error) {
        fail("what was written is refused", first, error.what());
    }
    evaluate(*function, {0.3, -0.7, 1.1});
}

void run_certificate(std::string_view bytes) {
    try {
        if (!verify::is_product_certificate(bytes)) {
            const verify::ImplicitComplex complex(verify::read_certificate(bytes));
            return;
        }
        for (const verify::ImplicitCertificate& factor : verify::read_product_certificate(bytes).factors)
            const verify::ImplicitComplex complex(factor);
    } catch (const verify::UnreadableCertificate&) {
    }
}

}  // namespace

std::span<const std::string_view> target_names() { return names; }

void run_target(std::string_view name, std::string_view bytes) {
    if (name == "expression") return run_expression(bytes);
    if (name == "certificate") return run_certificate(bytes);
    const std::optional<MeshDocument> document = parse(name, bytes);
    if (!document) return;
    const std::optional<std::string> first = format(name, *document);
    if (!first) return;
    const std::optional<MeshDocument> back = parse(name, *first);
    if (!back) fail("what was written is refused", *first, "");
    const std::optional<std::string> second = format(name, *back);
    if (second != first) fail("what was written changes when it is read", *first, second.value_or("refused"));
}

}  // namespace certa::fuzz
