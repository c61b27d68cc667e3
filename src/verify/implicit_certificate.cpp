// A reader for exactly the JSON that certificates are: everything else is refused. Integers have at most 18 digits;
// nothing is allocated that the text does not spell out.
#include "verify/implicit_certificate.h"

#include <certa/implicit.h>

#include <algorithm>
#include <charconv>
#include <functional>
#include <map>
#include <set>

namespace certa::verify {
namespace {

class Reader {
public:
    explicit Reader(std::string_view text) : text_(text) {}

    using Keys = std::map<std::string, std::function<void()>, std::less<>>;

    /// {"key": value, ...} with exactly the given keys, in any order; `optional` may be missing.
    void object(const Keys& keys, const std::set<std::string>& optional = {}) {
        expect('{');
        std::set<std::string> seen;
        do {
            const std::string key = string();
            const auto found = keys.find(key);
            if (found == keys.end()) fail("unknown key " + key);
            if (!seen.insert(key).second) fail("the key " + key + " occurs twice");
            expect(':');
            found->second();
        } while (accept(','));
        expect('}');
        for (const auto& [key, read] : keys) {
            if (seen.count(key) == 0 && optional.count(key) == 0) fail("the key " + key + " is missing");
        }
    }

    std::string string() {
        expect('"');
        std::string result;
        for (; at_ < text_.size() && text_[at_] != '"'; ++at_) {
            char c = text_[at_];
            if (c == '\\') {
                if (++at_ == text_.size()) break;
                c = text_[at_];
                if (c == 'n')
                    c = '\n';
                else if (c != '"' && c != '\\')
                    fail("an unknown escape");
            }
            result += c;
        }
        expect('"');
        return result;
    }

    std::int64_t integer() {
        skip();
        std::int64_t value = 0;
        const char* first = text_.data() + at_;
        const auto [end, error] = std::from_chars(first, text_.data() + text_.size(), value);
        if (error != std::errc() || end - first > 18) fail("expected an integer");
        at_ += static_cast<std::size_t>(end - first);
        return value;
    }

    std::vector<std::int64_t> integers() {
        std::vector<std::int64_t> result;
        expect('[');
        if (accept(']')) return result;
        do result.push_back(integer());
        while (accept(','));
        expect(']');
        return result;
    }

    /// [item, ...], at least one.
    template <class Item>
    void list(const Item& item) {
        expect('[');
        do item();
        while (accept(','));
        expect(']');
    }

    std::array<std::int64_t, 3> triple() {
        const std::vector<std::int64_t> values = integers();
        if (values.size() != 3) fail("expected three integers");
        return {values[0], values[1], values[2]};
    }

    void end() {
        skip();
        if (at_ != text_.size()) fail("text after the end");
    }
    [[noreturn]] void fail(const std::string& reason) const {
        throw UnreadableCertificate("byte " + std::to_string(at_ + 1) + ": " + reason);
    }

private:
    void skip() {
        while (at_ < text_.size() &&
               (text_[at_] == ' ' || text_[at_] == '\n' || text_[at_] == '\r' || text_[at_] == '\t'))
            ++at_;
    }
    bool accept(char c) {
        skip();
        if (at_ == text_.size() || text_[at_] != c) return false;
        ++at_;
        return true;
    }
    void expect(char c) {
        if (!accept(c)) fail(std::string("expected ") + c);
    }
    std::string_view text_;
    std::size_t at_ = 0;
};

constexpr std::string_view product_format = "certa implicit product";

ImplicitCertificate certificate_in(Reader& in) {
    ImplicitCertificate c;
    in.object({{"format",
                [&] {
                    if (in.string() != "certa implicit certificate") in.fail("another format");
                }},
               {"version",
                [&] {
                    if (in.integer() != 1) in.fail("another version");
                }},
               {"function", [&] { c.function = in.string(); }},
               {"mesh", [&] { c.mesh = in.string(); }},
               {"grid",
                [&] {
                    in.object({{"first", [&] { c.first = in.triple(); }},
                               {"count", [&] { c.count = in.triple(); }},
                               {"exponent", [&] { c.exponent = in.triple(); }},
                               {"resolution", [&] { c.resolution = in.integer(); }}});
                }},
               {"octree", [&] { c.octree = in.string(); }},
               {"negative_points", [&] { c.negative_points = in.integers(); }},
               {"marks", [&] { c.marks = in.integers(); }},
               {"vertex_edges", [&] { c.vertex_edges = in.integers(); }},
               {"loops",
                [&] {
                    c.clip = true;
                    c.loops = in.integers();
                }},
               {"hausdorff",
                [&] {
                    c.hausdorff = in.integers();
                    if (c.hausdorff.size() != 2 || c.hausdorff[0] <= 0 || c.hausdorff[0] >= std::int64_t{1} << 53 ||
                        c.hausdorff[1] < -900 || c.hausdorff[1] > 900)
                        in.fail("hausdorff is no length");
                }},
               {"genera", [&] { c.genera = in.integers(); }}},
              {"loops", "hausdorff", "mesh"});
    return c;
}

}  // namespace

ImplicitCertificate read_certificate(std::string_view text) {
    Reader in(text);
    ImplicitCertificate certificate = certificate_in(in);
    in.end();
    return certificate;
}

bool is_product_certificate(std::string_view text) { return text.substr(0, 64).find(product_format) != text.npos; }

ImplicitProductCertificate read_product_certificate(std::string_view text) {
    Reader in(text);
    ImplicitProductCertificate c;
    in.object({{"format",
                [&] {
                    if (in.string() != product_format) in.fail("another format");
                }},
               {"version",
                [&] {
                    if (in.integer() != 1) in.fail("another version");
                }},
               {"vertices", [&] { c.vertices = in.integers(); }},
               {"triangles", [&] { c.triangles = in.integers(); }},
               {"factors", [&] { in.list([&] { c.factors.push_back(certificate_in(in)); }); }}});
    in.end();
    if (c.vertices.size() != c.factors.size() || c.triangles.size() != c.factors.size())
        in.fail("numbers of vertices and triangles are not one per factor");
    return c;
}

}  // namespace certa::verify

namespace certa {

std::uint64_t estimate_check_memory(std::string_view certificate) {
    constexpr std::string_view key = "\"octree\"";
    constexpr std::uint64_t bytes_per_leaf = 3000;
    std::uint64_t largest = 0;  // factors of a product are checked one after the other
    for (std::size_t at = certificate.find(key); at != certificate.npos; at = certificate.find(key, at)) {
        at += key.size();
        std::uint64_t leaves = 0;
        const std::size_t first = certificate.find('"', at);
        for (at = first == certificate.npos ? certificate.size() : first + 1;
             at < certificate.size() && certificate[at] != '"'; ++at)
            leaves += certificate[at] != '(' ? 1 : 0;
        largest = std::max(largest, leaves);
    }
    return bytes_per_leaf * largest + certificate.size();
}

}  // namespace certa
