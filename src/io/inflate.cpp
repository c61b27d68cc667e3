// Decompression of zlib streams: RFC 1950 (frame and Adler-32 checksum) and RFC 1951 (deflate). Straight from the
// specifications: canonical Huffman codes are decoded bit by bit by counting how many codes of each length there are.
// Plan: bit reader, code table, the three kinds of blocks, the frame.
#include "io/inflate.h"

#include <array>
#include <cstdint>
#include <vector>

namespace certa::io {
namespace {

constexpr int longest_code = 15;

struct Damaged {};

/// Bits of a stream, least significant first.
class BitReader {
public:
    explicit BitReader(std::string_view bytes) : bytes_(bytes) {}

    std::uint32_t bits(int count) {
        while (filled_ < count) {
            if (next_ == bytes_.size()) throw Damaged{};
            buffer_ |= static_cast<std::uint32_t>(static_cast<unsigned char>(bytes_[next_++])) << filled_;
            filled_ += 8;
        }
        const std::uint32_t value = buffer_ & ((1U << count) - 1U);
        buffer_ >>= count;
        filled_ -= count;
        return value;
    }
    /// Drops the bits up to the next byte and takes whole bytes.
    std::string_view bytes(std::size_t count) {
        buffer_ = 0;
        filled_ = 0;
        if (count > bytes_.size() - next_) throw Damaged{};
        next_ += count;
        return bytes_.substr(next_ - count, count);
    }

private:
    std::string_view bytes_;
    std::size_t next_ = 0;
    std::uint32_t buffer_ = 0;  // never more than 7 bits are left over between calls: 7 + 8 + 8 fit
    int filled_ = 0;
};

/// A canonical Huffman code (RFC 1951, 3.2.2).
class Code {
public:
    explicit Code(const std::vector<std::uint8_t>& lengths) {
        for (const std::uint8_t length : lengths) ++counts_[length];
        counts_[0] = 0;
        int room = 1;
        for (int length = 1; length <= longest_code; ++length) {
            room = 2 * room - counts_[length];
            if (room < 0) throw Damaged{};
        }
        std::array<int, longest_code + 2> first{};
        for (int length = 1; length <= longest_code; ++length) first[length + 1] = first[length] + counts_[length];
        symbols_.resize(static_cast<std::size_t>(first[longest_code + 1]));
        for (std::size_t symbol = 0; symbol < lengths.size(); ++symbol)
            if (lengths[symbol] != 0)
                symbols_[static_cast<std::size_t>(first[lengths[symbol]]++)] = static_cast<std::uint16_t>(symbol);
    }

    std::uint32_t decode(BitReader& reader) const {
        int code = 0, first = 0, index = 0;
        for (int length = 1; length <= longest_code; ++length) {
            code |= static_cast<int>(reader.bits(1));
            const int count = counts_[length];
            if (code - count < first) return symbols_[static_cast<std::size_t>(index + code - first)];
            index += count;
            first = (first + count) << 1;
            code <<= 1;
        }
        throw Damaged{};
    }

private:
    std::array<int, longest_code + 1> counts_{};
    std::vector<std::uint16_t> symbols_;
};

constexpr std::array<std::uint16_t, 29> length_bases{3,  4,  5,  6,  7,  8,  9,  10, 11,  13,  15,  17,  19,  23, 27,
                                                     31, 35, 43, 51, 59, 67, 83, 99, 115, 131, 163, 195, 227, 258};
constexpr std::array<std::uint8_t, 29> length_bits{0, 0, 0, 0, 0, 0, 0, 0, 1, 1, 1, 1, 2, 2, 2,
                                                   2, 3, 3, 3, 3, 4, 4, 4, 4, 5, 5, 5, 5, 0};
constexpr std::array<std::uint16_t, 30> distance_bases{1,    2,    3,    4,    5,    7,    9,    13,    17,    25,
                                                       33,   49,   65,   97,   129,  193,  257,  385,   513,   769,
                                                       1025, 1537, 2049, 3073, 4097, 6145, 8193, 12289, 16385, 24577};
constexpr std::array<std::uint8_t, 30> distance_bits{0, 0, 0, 0, 1, 1, 2, 2,  3,  3,  4,  4,  5,  5,  6,
                                                     6, 7, 7, 8, 8, 9, 9, 10, 10, 11, 11, 12, 12, 13, 13};

class Inflater {
public:
    Inflater(std::string_view stream, std::size_t size) : reader_(stream), size_(size) { out_.reserve(size); }

    std::string run() {
        for (bool last = false; !last;) {
            last = reader_.bits(1) != 0;
            switch (reader_.bits(2)) {
                case 0:
                    copy_stored();
                    break;
                case 1:
                    decode_block(fixed_literals(), Code(std::vector<std::uint8_t>(30, 5)));
                    break;
                case 2:
                    decode_dynamic();
                    break;
                default:
                    throw Damaged{};
            }
        }
        if (out_.size() != size_) throw Damaged{};
        return std::move(out_);
    }

private:
    static Code fixed_literals() {
        std::vector<std::uint8_t> lengths(288, 8);
        for (std::size_t i = 144; i < 256; ++i) lengths[i] = 9;
        for (std::size_t i = 256; i < 280; ++i) lengths[i] = 7;
        return Code(lengths);
    }

    void need(std::size_t count) const {
        if (count > size_ - out_.size()) throw Damaged{};
    }

    void copy_stored() {
        const std::string_view header = reader_.bytes(4);
        const auto byte = [&](int i) { return static_cast<std::uint32_t>(static_cast<unsigned char>(header[i])); };
        const std::uint32_t length = byte(0) | byte(1) << 8;
        if ((length ^ (byte(2) | byte(3) << 8)) != 0xffff) throw Damaged{};
        need(length);
        out_ += reader_.bytes(length);
    }

    void decode_dynamic() {
        const std::uint32_t literals = reader_.bits(5) + 257, distances = reader_.bits(5) + 1,
                            codes = reader_.bits(4) + 4;
        if (literals > 286 || distances > 30) throw Damaged{};
        constexpr std::array<std::uint8_t, 19> order{16, 17, 18, 0, 8, 7, 9, 6, 10, 5, 11, 4, 12, 3, 13, 2, 14, 1, 15};
        std::vector<std::uint8_t> code_lengths(19, 0);
        for (std::uint32_t i = 0; i < codes; ++i) code_lengths[order[i]] = static_cast<std::uint8_t>(reader_.bits(3));
        const Code code(code_lengths);
        std::vector<std::uint8_t> lengths;
        while (lengths.size() < literals + distances) {
            const std::uint32_t symbol = code.decode(reader_);
            if (symbol < 16) {
                lengths.push_back(static_cast<std::uint8_t>(symbol));
                continue;
            }
            if (symbol == 16 && lengths.empty()) throw Damaged{};
            const std::uint8_t repeated = symbol == 16 ? lengths.back() : std::uint8_t{0};
            const std::uint32_t times = symbol == 16   ? 3 + reader_.bits(2)
                                        : symbol == 17 ? 3 + reader_.bits(3)
                                                       : 11 + reader_.bits(7);
            lengths.insert(lengths.end(), times, repeated);
        }
        if (lengths.size() != literals + distances) throw Damaged{};
        const auto middle = lengths.begin() + static_cast<std::ptrdiff_t>(literals);
        decode_block(Code({lengths.begin(), middle}), Code({middle, lengths.end()}));
    }

    void decode_block(const Code& literals, const Code& distances) {
        for (;;) {
            const std::uint32_t symbol = literals.decode(reader_);
            if (symbol == 256) return;
            if (symbol < 256) {
                need(1);
                out_ += static_cast<char>(symbol);
                continue;
            }
            if (symbol - 257 >= length_bases.size()) throw Damaged{};
            const std::size_t length = length_bases[symbol - 257] + reader_.bits(length_bits[symbol - 257]);
            const std::uint32_t kind = distances.decode(reader_);
            if (kind >= distance_bases.size()) throw Damaged{};
            const std::size_t distance = distance_bases[kind] + reader_.bits(distance_bits[kind]);
            if (distance > out_.size()) throw Damaged{};
            need(length);
            // Source and target may overlap: byte by byte.
            for (std::size_t k = 0; k < length; ++k) out_ += out_[out_.size() - distance];
        }
    }

    BitReader reader_;
    std::size_t size_;
    std::string out_;
};

std::uint32_t adler32(std::string_view bytes) {
    constexpr std::uint32_t prime = 65521;
    std::uint32_t a = 1, b = 0;
    for (const char c : bytes) {
        a = (a + static_cast<unsigned char>(c)) % prime;
        b = (b + a) % prime;
    }
    return b << 16 | a;
}

}  // namespace

std::optional<std::string> inflate_zlib(std::string_view stream, std::size_t size) {
    if (stream.size() < 6) return std::nullopt;
    const auto byte = [&](std::size_t i) { return static_cast<std::uint32_t>(static_cast<unsigned char>(stream[i])); };
    const bool is_deflate = (byte(0) & 15) == 8, has_dictionary = (byte(1) & 32) != 0;
    if (!is_deflate || has_dictionary || (byte(0) << 8 | byte(1)) % 31 != 0) return std::nullopt;
    try {
        std::string bytes = Inflater(stream.substr(2, stream.size() - 6), size).run();
        const std::size_t end = stream.size() - 4;
        const std::uint32_t sum = byte(end) << 24 | byte(end + 1) << 16 | byte(end + 2) << 8 | byte(end + 3);
        if (sum != adler32(bytes)) return std::nullopt;
        return bytes;
    } catch (const Damaged&) {
        return std::nullopt;
    }
}

}  // namespace certa::io
