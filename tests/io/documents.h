#pragma once
// Documents to write and read back, and the comparison to the bit.
#include <certa/io.h>
#include <gtest/gtest.h>

#include <bit>
#include <limits>
#include <random>
#include <string>
#include <vector>

namespace certa::test {

/// Coordinates that break formats: signed zero, denormals, the largest and the least steps, long decimals.
inline const std::vector<double>& hostile_numbers() {
    using Limits = std::numeric_limits<double>;
    static const std::vector<double> numbers{0.0,
                                             -0.0,
                                             Limits::denorm_min(),
                                             -Limits::denorm_min(),
                                             5e-310,
                                             Limits::min(),
                                             Limits::max(),
                                             -Limits::max(),
                                             1e308,
                                             0.1,
                                             1.0 / 3.0,
                                             -2.0 / 3.0,
                                             1.0 + Limits::epsilon(),
                                             1.0 - Limits::epsilon() / 2,
                                             123456789.123456789,
                                             9007199254740993.0,
                                             1e22,
                                             1e23,
                                             4.35,
                                             2.2250738585072011e-308};
    return numbers;
}

/// Any finite double, all exponents alike.
inline double random_double(std::mt19937_64& random) {
    for (;;) {
        const double value = std::bit_cast<double>(random());
        if (value - value == 0.0) return value;
    }
}

inline double hostile_or_random(std::mt19937_64& random, std::size_t i) {
    return i < hostile_numbers().size() ? hostile_numbers()[i] : random_double(random);
}

inline void add_points(MeshDocument& document, std::size_t count, std::mt19937_64& random) {
    for (std::size_t i = 0; i < count; ++i)
        document.complex.positions.push_back({hostile_or_random(random, 3 * i), hostile_or_random(random, 3 * i + 1),
                                              hostile_or_random(random, 3 * i + 2)});
}

inline VertexId random_vertex(const MeshDocument& document, std::mt19937_64& random) {
    return VertexId{static_cast<std::uint32_t>(random() % document.complex.positions.size())};
}

inline void add_polygon(MeshDocument& document, std::size_t degree, std::mt19937_64& random) {
    std::vector<VertexId> corners(degree);
    for (VertexId& corner : corners) corner = random_vertex(document, random);
    add_facet(document.complex, {corners});
}

inline void add_segments(MeshDocument& document, std::size_t count, std::mt19937_64& random) {
    for (std::size_t i = 0; i < count; ++i)
        document.complex.segments.push_back({random_vertex(document, random), random_vertex(document, random)});
}

inline void add_tetrahedra(MeshDocument& document, std::size_t count, std::mt19937_64& random) {
    for (std::size_t i = 0; i < count; ++i) {
        Tetrahedron corners;
        for (VertexId& corner : corners) corner = random_vertex(document, random);
        document.tetrahedra.push_back(corners);
    }
}

inline std::vector<std::int32_t> random_markers(std::size_t count, std::mt19937_64& random) {
    std::vector<std::int32_t> markers(count);
    for (std::int32_t& marker : markers) marker = static_cast<std::int32_t>(random());
    if (count > 1)
        markers[0] = std::numeric_limits<std::int32_t>::min(), markers[1] = std::numeric_limits<std::int32_t>::max();
    return markers;
}

inline Field random_field(std::string name, Location location, std::size_t count, std::uint32_t components,
                          std::mt19937_64& random) {
    std::vector<double> values(count * components);
    for (std::size_t i = 0; i < values.size(); ++i) values[i] = hostile_or_random(random, i);
    return {std::move(name), location, components, std::move(values)};
}

inline Field integer_field(std::string name, Location location, std::vector<std::int64_t> values) {
    return {std::move(name), location, 1, std::move(values)};
}

inline bool same_bits(double a, double b) { return std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b); }
inline bool same_bits(const Point3& a, const Point3& b) {
    return same_bits(a.x, b.x) && same_bits(a.y, b.y) && same_bits(a.z, b.z);
}
inline bool same_bits(std::int64_t a, std::int64_t b) { return a == b; }

template <class T>
void expect_same_numbers(const std::vector<T>& a, const std::vector<T>& b, const std::string& what) {
    ASSERT_EQ(a.size(), b.size()) << what;
    for (std::size_t i = 0; i < a.size(); ++i) ASSERT_TRUE(same_bits(a[i], b[i])) << what << " differs at " << i;
}

/// Fields are compared by name and location: their order is the format's affair.
inline void expect_same_fields(const MeshDocument& a, const MeshDocument& b) {
    ASSERT_EQ(a.fields.size(), b.fields.size());
    for (const Field& field : a.fields) {
        const Field* other = nullptr;
        for (const Field& candidate : b.fields)
            if (candidate.name == field.name && candidate.location == field.location) other = &candidate;
        ASSERT_NE(other, nullptr) << field.name;
        EXPECT_EQ(field.components, other->components) << field.name;
        ASSERT_EQ(field.values.index(), other->values.index()) << field.name;
        std::visit(
            [&](const auto& values) {
                expect_same_numbers(values, std::get<std::decay_t<decltype(values)>>(other->values), field.name);
            },
            field.values);
    }
}

inline void expect_same(const MeshDocument& a, const MeshDocument& b) {
    const PiecewiseLinearComplex &p = a.complex, &q = b.complex;
    expect_same_numbers(p.positions, q.positions, "positions");
    EXPECT_EQ(p.segments, q.segments);
    EXPECT_EQ(p.corners, q.corners);
    EXPECT_EQ(p.polygon_offsets, q.polygon_offsets);
    EXPECT_EQ(p.facet_offsets, q.facet_offsets);
    EXPECT_EQ(p.hole_offsets, q.hole_offsets);
    expect_same_numbers(p.facet_holes, q.facet_holes, "holes of facets");
    expect_same_numbers(p.region_holes, q.region_holes, "hole points");
    EXPECT_EQ(p.point_markers, q.point_markers);
    EXPECT_EQ(p.segment_markers, q.segment_markers);
    EXPECT_EQ(p.facet_markers, q.facet_markers);
    ASSERT_EQ(p.region_seeds.size(), q.region_seeds.size());
    for (std::size_t i = 0; i < p.region_seeds.size(); ++i) {
        EXPECT_TRUE(same_bits(p.region_seeds[i].place, q.region_seeds[i].place));
        EXPECT_TRUE(same_bits(p.region_seeds[i].attribute, q.region_seeds[i].attribute));
        EXPECT_TRUE(same_bits(p.region_seeds[i].max_volume, q.region_seeds[i].max_volume));
    }
    EXPECT_EQ(a.tetrahedra, b.tetrahedra);
    expect_same_fields(a, b);
}

/// What the text of a file is read as, and the refusal that a damaged one gets.
inline IoError refusal(std::string_view text, Format format) {
    try {
        parse_document(text, format, "file");
    } catch (const IoError& error) {
        return error;
    }
    return {"file", 0, "read without complaint"};
}

}  // namespace certa::test
