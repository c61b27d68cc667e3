// Random functions against each other's answers (docs/performance.md): implicit_random FIRST_SEED COUNT
// Each function is decided by the growth engine and its certificate checked; decided again with its axes exchanged, its
// sign turned and another box; and, if it is closed, by the engine plantinga-vegter. Whatever two of them decide
// must be the same, and every certificate accepted. Four kinds: bumps, a sphere with a random bounded disturbance,
// quartics, and waves that the box clips. Prints what disagrees, and the counts in the end; the exit code is 1 then.
#include <certa/implicit.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "core/random.h"

namespace {

using certa::Expression;
using Function = std::function<Expression(const Expression&, const Expression&, const Expression&)>;

Expression bumps(certa::core::Random& random, const Expression& x, const Expression& y, const Expression& z) {
    Expression f = 0.35;
    for (int i = 0; i < 4; ++i) {
        const Expression r2 = pow(x - random.uniform(-0.9, 0.9), 2) + pow(y - random.uniform(-0.9, 0.9), 2) +
                              pow(z - random.uniform(-0.9, 0.9), 2);
        f = f - random.uniform(-0.3, 1.2) * exp(-random.uniform(2, 7) * r2);
    }
    return f;
}

/// Some operations on what is there already: deep, with common parts, defined everywhere.
Expression anything(certa::core::Random& random, const Expression& x, const Expression& y, const Expression& z) {
    std::vector<Expression> parts{x, y, z, random.uniform(-2, 2)};
    const auto any = [&] { return parts[random.below(parts.size())]; };
    for (int i = 0; i < 7; ++i) {
        const Expression a = any(), b = any();
        switch (random.below(11)) {
            case 0:
                parts.push_back(a + b);
                break;
            case 1:
                parts.push_back(a - b);
                break;
            case 2:
                parts.push_back(a * b);
                break;
            case 3:
                parts.push_back(a / (1.5 + b * b));
                break;
            case 4:
                parts.push_back(sin(a));
                break;
            case 5:
                parts.push_back(cos(2.0 * a));
                break;
            case 6:
                parts.push_back(tanh(a) - b);
                break;
            case 7:
                parts.push_back(exp(-1.0 * (a * a)));
                break;
            case 8:
                parts.push_back(sqrt(a * a + 0.1));
                break;
            case 9:
                parts.push_back(log(b * b + 0.5));
                break;
            default:
                parts.push_back(pow(a, 3.0));
                break;
        }
    }
    return parts.back();
}

Expression quartic(certa::core::Random& random, const Expression& x, const Expression& y, const Expression& z) {
    Expression f = pow(x, 4) + pow(y, 4) + pow(z, 4) - random.uniform(0.2, 1.5);
    const Expression axes[3] = {x, y, z};
    for (int i = 0; i < 8; ++i) {
        Expression term = random.uniform(-1.2, 1.2);
        for (std::uint64_t k = 0, degree = 1 + random.below(3); k < degree; ++k) term = term * axes[random.below(3)];
        f = f + term;
    }
    return f;
}

Expression waves(certa::core::Random& random, const Expression& x, const Expression& y, const Expression& z) {
    Expression f = random.uniform(-0.6, 0.6);
    for (int i = 0; i < 4; ++i)
        f = f + random.uniform(-1, 1) * sin(random.uniform(-3, 3) * x + random.uniform(-3, 3) * y +
                                            random.uniform(-3, 3) * z + random.uniform(0, 6));
    return f;
}

Expression make(std::uint64_t seed, const Expression& x, const Expression& y, const Expression& z) {
    certa::core::Random random(seed);
    switch (seed % 4) {
        case 0:
            return bumps(random, x, y, z);
        case 1: {
            const double weight = random.uniform(0.1, 0.9);
            return x * x + y * y + z * z - 2.5 + weight * atan(3.0 * anything(random, x, y, z));
        }
        case 2:
            return quartic(random, x, y, z);
        default:
            return waves(random, x, y, z);
    }
}

using Forms = std::vector<std::pair<int, int>>;

struct Counts {
    int functions = 0, decided = 0, checked = 0, both_grids = 0, both_engines = 0, wrong = 0;
};

Forms forms_of(const certa::ImplicitResult& result) {
    Forms forms;
    for (const certa::ImplicitComponent& c : result.components) forms.emplace_back(c.genus, c.loops);
    std::sort(forms.begin(), forms.end());
    return forms;
}

void report(std::uint64_t seed, const char* what, const Expression& f, Counts& counts) {
    ++counts.wrong;
    std::printf("seed %llu: %s\n%s\n", static_cast<unsigned long long>(seed), what, format_expression(f).c_str());
    std::fflush(stdout);
}

/// Nothing for what is not decided.
bool decide(std::uint64_t seed, const Expression& f, const certa::Point3& low, const certa::Point3& high,
            certa::ImplicitOptions options, Forms& forms, Counts& counts) {
    options.certificate = options.engine == certa::ImplicitEngine::growth;
    const certa::ImplicitResult result = mesh_implicit(f, low, high, options);
    if (result.verdict == certa::ImplicitVerdict::undecided) return false;
    forms = forms_of(result);
    if (!options.certificate) return true;
    ++counts.checked;
    const certa::ImplicitCheck check = check_implicit(result.mesh, format_expression(f), result.certificate);
    if (!check.ok()) report(seed, ("the checker refuses: " + check.violations.front()).c_str(), f, counts);
    return true;
}

void compare(std::uint64_t seed, Counts& counts) {
    ++counts.functions;
    const Expression x = Expression::x(), y = Expression::y(), z = Expression::z();
    const Expression f = make(seed, x, y, z);
    certa::ImplicitOptions options;
    options.max_cells = 20'000;
    options.clip = seed % 4 == 3;
    Forms forms, others;
    const certa::Point3 low{-2.21, -2.13, -2.17}, high{2.11, 2.23, 2.19};
    if (!decide(seed, f, low, high, options, forms, counts)) return;
    ++counts.decided;
    // Of a clipped surface the box is part of the question: it turns with the axes.
    const certa::Point3 turned_low =
        options.clip ? certa::Point3{low.y, low.z, low.x} : certa::Point3{-2.4, -2.3, -2.2};
    const certa::Point3 turned_high =
        options.clip ? certa::Point3{high.y, high.z, high.x} : certa::Point3{2.2, 2.5, 2.3};
    const Expression turned = -make(seed, z, x, y);
    if (decide(seed, turned, turned_low, turned_high, options, others, counts)) {
        ++counts.both_grids;
        if (others != forms) report(seed, "another grid says otherwise", f, counts);
    }
    if (options.clip) return;
    options.engine = certa::ImplicitEngine::plantinga_vegter;
    options.max_cells = 50'000;
    if (decide(seed, f, low, high, options, others, counts)) {
        ++counts.both_engines;
        if (others != forms) report(seed, "the other engine says otherwise", f, counts);
    }
}

}  // namespace

int main(int count, char** arguments) {
    if (count != 3) return 2;
    const std::uint64_t first = std::strtoull(arguments[1], nullptr, 10),
                        many = std::strtoull(arguments[2], nullptr, 10);
    Counts counts;
    const auto print = [&] {
        std::printf(
            "%d functions, %d decided, %d certificates checked, %d decided on both grids, %d by both engines, %d "
            "disagreements\n",
            counts.functions, counts.decided, counts.checked, counts.both_grids, counts.both_engines, counts.wrong);
        std::fflush(stdout);
    };
    for (std::uint64_t seed = first; seed < first + many; ++seed) {
        compare(seed, counts);
        if (counts.functions % 100 == 0) print();
    }
    print();
    return counts.wrong == 0 ? 0 : 1;
}
