// Repair in rounds: what each round finds is mended all at once, and what the mending brings to light (points of
// intersection are rounded, triple points appear) is left to the next, until nothing is left, nothing can be done, or
// the rounds are used up. Nothing is claimed about the result: conform validates it as it does any input.
#include <numeric>

#include "conforming/build_complex.h"
#include "conforming/repair.h"
#include "conforming/validate.h"

namespace certa {
namespace {

using namespace conforming;

constexpr int most_rounds = 24;

void append(std::vector<Defect>& list, std::vector<Defect> more) {
    list.insert(list.end(), std::make_move_iterator(more.begin()), std::make_move_iterator(more.end()));
}

double diagonal_of(const PiecewiseLinearComplex& input) {
    Complex points;
    points.points = input.positions;
    build_incidences(points);
    return points.diagonal;
}

}  // namespace

RepairedComplex repair_complex(const PiecewiseLinearComplex& complex, const ConformOptions& options,
                               const RunControl& control) {
    ValidationReport structure = validate_structure(complex);
    if (!structure.buildable) throw InputError(std::move(structure.defects));
    RepairedComplex result{complex, std::vector<FacetId>(complex.facet_count()), {}};
    for (std::uint32_t f = 0; f < result.facet_sources.size(); ++f) result.facet_sources[f] = FacetId{f};
    if (options.repair) {
        CleanedComplex cleaned = clean_structure(complex);
        result.complex = std::move(cleaned.complex);
        result.repairs = std::move(cleaned.repairs);
    }
    if (options.triangulate) {
        RepairedComplex cut =
            triangulate_facets(result.complex, options.planarity.resolve(diagonal_of(result.complex)));
        result.complex = std::move(cut.complex);
        result.facet_sources = std::move(cut.facet_sources);
        append(result.repairs, std::move(cut.repairs));
    }
    for (int round = 0; options.repair && round < most_rounds && !control.cancelled(); ++round) {
        control.report("repair", static_cast<double>(round) / most_rounds);
        structure = validate_structure(result.complex);
        if (!structure.ok()) {
            CleanedComplex cleaned = clean_structure(result.complex);
            result.complex = std::move(cleaned.complex);
            append(result.repairs, std::move(cleaned.repairs));
            structure = validate_structure(result.complex);
        }
        const Complex built = build_complex(result.complex);
        if (validate_geometry(result.complex, built, structure, options).ok()) break;
        RepairPlan plan = plan_repairs(result.complex, built, options);
        if (plan.empty()) break;
        result.complex = carry_out(plan, result.complex, built);
        append(result.repairs, std::move(plan.repairs));
    }
    return result;
}

}  // namespace certa
