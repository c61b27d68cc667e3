// Violations and the words in which they are told. Numbers of elements are 1-based in messages, 0-based as data.
#include "verify/report.h"

#include <charconv>

namespace certa::verify {
namespace {
constexpr std::size_t kept_per_promise = 100;
}

const char* name_of(Promise promise) {
    switch (promise) {
        case Promise::well_formed:
            return "well-formed";
        case Promise::delaunay:
            return "delaunay";
        case Promise::conforming:
            return "conforming";
        case Promise::faithful:
            return "faithful";
        case Promise::labelled:
            return "labelled";
        case Promise::gabriel:
            break;
    }
    return "gabriel";
}

void Findings::add(Promise promise, std::vector<ElementRef> elements, const Point3& place, std::string message) {
    const auto p = static_cast<std::size_t>(promise);
    ++count_;
    ++counts_[p];
    if (kept_[p] == kept_per_promise) return;
    ++kept_[p];
    violations_.push_back({name_of(promise), std::move(elements), place, std::move(message)});
    promises_.push_back(promise);
}

void Findings::append(Findings&& other) {
    count_ += other.count_;
    for (std::size_t p = 0; p < counts_.size(); ++p) counts_[p] += other.counts_[p];
    for (std::size_t i = 0; i < other.violations_.size(); ++i) {
        const auto p = static_cast<std::size_t>(other.promises_[i]);
        if (kept_[p] == kept_per_promise) continue;
        ++kept_[p];
        violations_.push_back(std::move(other.violations_[i]));
        promises_.push_back(other.promises_[i]);
    }
}

ElementRef vertex_ref(std::uint32_t index) { return {ElementKind::vertex, index}; }
ElementRef segment_ref(std::uint32_t index) { return {ElementKind::segment, index}; }
ElementRef facet_ref(std::uint32_t index) { return {ElementKind::facet, index}; }
ElementRef tetrahedron_ref(std::uint32_t index) { return {ElementKind::tetrahedron, index}; }
ElementRef triangle_ref(std::uint32_t index) { return {ElementKind::triangle, index}; }
ElementRef edge_ref(std::uint32_t index) { return {ElementKind::edge, index}; }

std::string show(double value) {
    char text[32];
    return {text, std::to_chars(text, text + sizeof text, value).ptr};
}
std::string show(const Point3& p) { return "(" + show(p.x) + ", " + show(p.y) + ", " + show(p.z) + ")"; }

std::string show_vertices(const std::vector<std::uint32_t>& vertices) {
    std::string text = vertices.size() == 1 ? "vertex " : "vertices ";
    for (std::size_t i = 0; i < vertices.size(); ++i) {
        if (i > 0) text += ", ";
        text += std::to_string(std::uint64_t{vertices[i]} + 1);
    }
    return text;
}
std::string show(const char* kind, std::uint32_t index) {
    return std::string(kind) + ' ' + std::to_string(std::uint64_t{index} + 1);
}

}  // namespace certa::verify
