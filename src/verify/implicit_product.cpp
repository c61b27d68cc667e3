// docs/implicit-theorem.md, "products". Depth first, so that common zeros are met at once; first derivatives only,
// other than in the mesher.
#include "verify/implicit_product.h"

#include <certa/types.h>

#include <cmath>

#include "verify/report.h"

namespace certa::verify {
namespace {

constexpr int deepest = 45;
constexpr std::size_t most_boxes = 4'000'000;

bool is_apart(Enclosures& f, Enclosures& g, const BoxOfDoubles& box) {
    if (f.misses_zero(box) || g.misses_zero(box)) return true;
    std::array<double, 3> center;
    for (std::size_t a = 0; a < 3; ++a) center[a] = middle_of(box.low[a], box.high[a]);
    const std::array<double, 4> at_f = f.guess(center), at_g = g.guess(center);
    double across = 0, square = 0;
    for (std::size_t a = 1; a < 4; ++a) {
        across += at_f[a] * at_g[a];
        square += at_g[a] * at_g[a];
    }
    const double t = across / square;
    return std::isfinite(t) && f.combination_misses_zero(g, t, box);
}

}  // namespace

std::string check_apart(const ImplicitFunction& f, const ImplicitFunction& g, const BoxOfDoubles& box,
                        const RunControl& control) {
    struct Part {
        BoxOfDoubles box;
        int depth;
    };
    Enclosures of_f(f), of_g(g);
    std::vector<Part> work{{box, 0}};
    for (std::size_t count = 0; !work.empty(); ++count) {
        const Part part = work.back();
        work.pop_back();
        if (is_apart(of_f, of_g, part.box)) continue;
        if (control.cancelled()) return "the check was cancelled";
        if (part.depth == deepest || count > most_boxes)
            return "two factors are not proved apart, at " +
                   show(Point3{part.box.low[0], part.box.low[1], part.box.low[2]});
        for (unsigned k = 0; k < 8; ++k) {
            Part child{part.box, part.depth + 1};
            for (std::size_t a = 0; a < 3; ++a) {
                const double middle = middle_of(part.box.low[a], part.box.high[a]);
                (((k >> a) & 1u) == 0 ? child.box.high : child.box.low)[a] = middle;
            }
            work.push_back(child);
        }
    }
    return {};
}

}  // namespace certa::verify
