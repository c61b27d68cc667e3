// Decoding the data arrays of VTK's XML files.
// Layouts: uncompressed [bytes][data]; compressed [blocks][block size][size of last][compressed sizes ...][blocks ...];
// the header in UInt32 or UInt64. Base64 inline or appended; raw only appended. Sizes are checked against what is there
// before anything is allocated. Plan: bytes of a block, then numbers from bytes, or numbers from text.
#include "io/vtk_array.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "io/base64.h"
#include "io/byte_cursor.h"
#include "io/inflate.h"

namespace certa::io {
namespace {

class ArrayDecoder {
public:
    ArrayDecoder(const VtkArray& array, const VtkEncoding& encoding, std::string_view text, const std::string& name)
        : array_(array), encoding_(encoding), text_(text), name_(name), lines_(text, name, TextCursor::no_comments) {}

    VtkValues decode() const {
        if (array_.format == VtkFormat::text)
            return is_float() ? VtkValues(text_numbers()) : VtkValues(text_integers());
        const std::string_view source = find_source();
        const std::string data = source.empty()         ? std::string()
                                 : encoding_.compressed ? inflated(source)
                                                        : plain(source);
        return numbers_of(data);
    }

    [[noreturn]] void fail(const std::string& reason) const {
        lines_.fail_at(array_.tag, "the array '" + array_.name + "': " + reason);
    }

private:
    bool is_float() const { return array_.type.starts_with("Float"); }

    // A cursor on the file that ends with the array: its line numbers are those of the file.
    TextCursor content_cursor() const {
        TextCursor cursor(text_.substr(0, array_.end), name_, TextCursor::no_comments);
        cursor.move_to(array_.start);
        return cursor;
    }
    std::vector<double> text_numbers() const {
        std::vector<double> values;
        for (TextCursor cursor = content_cursor(); !cursor.at_end();) values.push_back(cursor.number("a number"));
        return values;
    }
    std::vector<std::int64_t> text_integers() const {
        std::vector<std::int64_t> values;
        for (TextCursor cursor = content_cursor(); !cursor.at_end();)
            values.push_back(cursor.integer("a whole number"));
        return values;
    }

    /// Where the array's bytes start; they end with the array or, appended, before the end of the file.
    std::string_view find_source() const {
        if (array_.format == VtkFormat::binary) {
            std::string_view source = text_.substr(array_.start, array_.end - array_.start);
            const std::size_t first = source.find_first_not_of(" \t\r\n");
            return first == std::string_view::npos ? std::string_view() : source.substr(first);
        }
        if (encoding_.appended_start == 0) fail("its data is appended, but the file has no appended data");
        if (array_.offset >= text_.size() - encoding_.appended_start) fail("its offset is beyond the end of the file");
        return text_.substr(encoding_.appended_start + static_cast<std::size_t>(array_.offset));
    }

    bool is_base64() const { return array_.format == VtkFormat::binary || encoding_.appended_base64; }

    /// The first `size` bytes of a source; fewer if it ends before.
    std::string first_bytes(std::string_view source, std::size_t size) const {
        if (!is_base64()) return std::string(source.substr(0, size));
        std::optional<std::string> bytes = decode_base64(source, size);
        if (!bytes) fail("its base64 is damaged or cut short");
        return std::move(*bytes);
    }

    std::size_t header_bytes() const { return encoding_.wide_headers ? 8 : 4; }

    std::vector<std::uint64_t> header(std::string_view source, std::size_t numbers) const {
        const std::string bytes = first_bytes(source, numbers * header_bytes());
        if (bytes.size() < numbers * header_bytes()) fail("its data is cut short");
        ByteCursor cursor(bytes, name_, encoding_.order);
        std::vector<std::uint64_t> values;
        for (std::size_t i = 0; i < numbers; ++i)
            values.push_back(encoding_.wide_headers ? cursor.read<std::uint64_t>("a size")
                                                    : cursor.read<std::uint32_t>("a size"));
        return values;
    }

    std::string plain(std::string_view source) const {
        const std::uint64_t size = header(source, 1)[0];
        if (size > source.size()) fail("its size of " + std::to_string(size) + " bytes is beyond the end of the file");
        std::string bytes = first_bytes(source, header_bytes() + static_cast<std::size_t>(size));
        if (bytes.size() < header_bytes() + size) fail("its data is cut short");
        bytes.erase(0, header_bytes());
        return bytes;
    }

    std::string inflated(std::string_view source) const {
        const std::uint64_t blocks = header(source, 1)[0];
        if (blocks == 0) return {};
        if (blocks > source.size() / header_bytes()) fail("its number of blocks is beyond the end of the file");
        const std::vector<std::uint64_t> sizes = header(source, 3 + static_cast<std::size_t>(blocks));
        const std::uint64_t block = sizes[1], last = sizes[2];
        std::uint64_t packed = 0;
        // deflate packs at most 1032 bytes into one.
        constexpr std::uint64_t best_ratio = 1032;
        for (std::size_t i = 3; i < sizes.size(); ++i) {
            if (sizes[i] > source.size()) fail("the size of a block is beyond the end of the file");
            const std::uint64_t size = (i + 1 == sizes.size() && last != 0) ? last : block;
            if (size / best_ratio > sizes[i]) fail("the size of a block is more than it can hold");
            packed += sizes[i];
        }
        if (packed > source.size()) fail("the sizes of the blocks are beyond the end of the file");
        const std::size_t header_size = sizes.size() * header_bytes();
        const std::string bytes = first_bytes(source, header_size + static_cast<std::size_t>(packed));
        if (bytes.size() < header_size + packed) fail("its data is cut short");
        std::string data;
        std::size_t position = header_size;
        for (std::size_t i = 3; i < sizes.size(); ++i) {
            const std::uint64_t size = (i + 1 == sizes.size() && last != 0) ? last : block;
            const auto part = inflate_zlib(std::string_view(bytes).substr(position, static_cast<std::size_t>(sizes[i])),
                                           static_cast<std::size_t>(size));
            if (!part) fail("its compressed data is damaged");
            data += *part;
            position += static_cast<std::size_t>(sizes[i]);
        }
        return data;
    }

    template <class Stored, class Value>
    std::vector<Value> converted(const std::string& data) const {
        if (data.size() % sizeof(Stored) != 0) fail("its size is no multiple of the size of a number");
        ByteCursor cursor(data, name_, encoding_.order);
        std::vector<Value> values(data.size() / sizeof(Stored));
        for (Value& value : values) {
            const Stored stored = cursor.read<Stored>("a number");
            if constexpr (std::is_floating_point_v<Stored>) {
                if (!std::isfinite(stored)) fail("a number is not finite");
            } else if constexpr (std::is_same_v<Stored, std::uint64_t>) {
                if (stored > static_cast<std::uint64_t>(std::numeric_limits<std::int64_t>::max()))
                    fail("a number is beyond 64-bit integers");
            }
            value = static_cast<Value>(stored);  // NOLINT(bugprone-signed-char-misuse): the number is meant
        }
        return values;
    }

    VtkValues numbers_of(const std::string& data) const {
        const std::string& type = array_.type;
        if (type == "Float64") return converted<double, double>(data);
        if (type == "Float32") return converted<float, double>(data);
        if (type == "Int8") return converted<std::int8_t, std::int64_t>(data);
        if (type == "UInt8") return converted<std::uint8_t, std::int64_t>(data);
        if (type == "Int16") return converted<std::int16_t, std::int64_t>(data);
        if (type == "UInt16") return converted<std::uint16_t, std::int64_t>(data);
        if (type == "Int32") return converted<std::int32_t, std::int64_t>(data);
        if (type == "UInt32") return converted<std::uint32_t, std::int64_t>(data);
        if (type == "UInt64") return converted<std::uint64_t, std::int64_t>(data);
        return converted<std::int64_t, std::int64_t>(data);
    }

    const VtkArray& array_;
    const VtkEncoding& encoding_;
    std::string_view text_;
    const std::string& name_;
    TextCursor lines_;
};

}  // namespace

VtkValues decode_array(const VtkArray& array, const VtkEncoding& encoding, std::string_view text,
                       const std::string& name, std::uint64_t count) {
    const ArrayDecoder decoder(array, encoding, text, name);
    VtkValues values = decoder.decode();
    const std::size_t size = std::visit([](const auto& v) { return v.size(); }, values);
    if (size % array.components != 0 || size / array.components != count)
        decoder.fail(std::to_string(size) + " numbers where " + std::to_string(count) + " times " +
                     std::to_string(array.components) + " were expected");
    return values;
}

}  // namespace certa::io
