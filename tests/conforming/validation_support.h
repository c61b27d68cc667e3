#pragma once
// Small complexes in few words, and reports in comparable form.
#include <certa/conforming.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "conforming/build_complex.h"
#include "conforming/validate.h"

namespace certa::test {

using Ring = std::vector<std::uint32_t>;

struct Builder {
    PiecewiseLinearComplex complex;

    explicit Builder(std::vector<Point3> points) { complex.positions = std::move(points); }

    /// Vertices are 0-based.
    Builder& facet(const std::vector<Ring>& polygons, const std::vector<Point3>& holes = {}) {
        std::vector<std::vector<VertexId>> ids;
        for (const Ring& ring : polygons) {
            auto& out = ids.emplace_back();
            for (const std::uint32_t v : ring) out.push_back(VertexId{v});
        }
        add_facet(complex, ids, holes);
        return *this;
    }
    Builder& segment(std::uint32_t a, std::uint32_t b) {
        complex.segments.push_back({VertexId{a}, VertexId{b}});
        return *this;
    }
};

inline conforming::ValidationReport report_of(const PiecewiseLinearComplex& complex,
                                              const ConformOptions& options = {}) {
    return conforming::validate(complex, options);
}
inline conforming::ValidationReport report_of(const Builder& builder, const ConformOptions& options = {}) {
    return report_of(builder.complex, options);
}

/// "crossing_facets f1 f2": elements 1-based, as messages have them.
inline std::string summary_of(const Defect& defect) {
    std::string text = name_of(defect.kind);
    for (const ElementRef& e : defect.elements) {
        text += ' ';
        text += name_of(e.kind)[0];
        text += std::to_string(e.index + 1);
    }
    return text;
}

inline std::vector<std::string> summaries_of(const std::vector<Defect>& defects) {
    std::vector<std::string> list;
    for (const Defect& defect : defects) list.push_back(summary_of(defect));
    std::sort(list.begin(), list.end());
    return list;
}

inline std::vector<std::string> defects_of(const PiecewiseLinearComplex& complex, const ConformOptions& options = {}) {
    return summaries_of(report_of(complex, options).defects);
}
inline std::vector<std::string> defects_of(const Builder& builder, const ConformOptions& options = {}) {
    return defects_of(builder.complex, options);
}

using Strings = std::vector<std::string>;

/// The single defect of a report; an empty one, and a failed test, when there is none or are several.
inline Defect only_defect(const conforming::ValidationReport& report) {
    EXPECT_EQ(report.defects.size(), 1u) << ::testing::PrintToString(summaries_of(report.defects));
    return report.defects.size() == 1 ? report.defects[0] : Defect{};
}

}  // namespace certa::test
