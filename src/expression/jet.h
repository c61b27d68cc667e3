#pragma once
// Forward automatic differentiation on a tape: value, gradient and Hessian, in doubles or in intervals.
//
// Laws: the interval results enclose value and derivatives of the real function at every point of the box, and are
// undefined where an operation is, or may be, undefined on the box. An instruction's derivatives that are 0 for every
// argument are not computed (the masks of the tape), so they are exactly 0.
#include <array>
#include <cstddef>
#include <vector>

#include "expression/scalar.h"
#include "expression/tape.h"

namespace certa::expression {

template <class Number>
using Place = std::array<Number, 3>;

/// Value, and as many derivatives as were asked for.
template <class Number>
struct Jet {
    Number value{};
    std::array<Number, 3> gradient{};
    std::array<Number, 6> hessian{};
};

/// One thread's memory for evaluations of one tape. Evaluating allocates nothing.
template <class Number>
class Workspace {
public:
    explicit Workspace(const Tape& tape) : tape_(&tape), jets_(tape.size()) {}

    /// Order 0: the value only; 1: the gradient too; 2: the Hessian too. The result lives until the next evaluation.
    template <int Order>
    const Jet<Number>& evaluate(const Place<Number>& place) {
        const auto& instructions = tape_->instructions();
        for (std::size_t k = 0; k < instructions.size(); ++k) step<Order>(instructions[k], place, jets_[k]);
        return jets_.back();
    }

private:
    /// f, f' and f'' of a unary operation.
    struct Outer {
        Number value{}, slope{}, bend{};
    };

    template <int Order>
    void step(const Instruction& i, const Place<Number>& place, Jet<Number>& out) {
        switch (operand_count(i.op)) {
            case 0:
                leaf<Order>(i, place, out);
                break;
            case 1:
                unary<Order>(i, jets_[i.first], out);
                break;
            default:
                binary<Order>(i, jets_[i.first], jets_[i.second], out);
        }
    }

    template <int Order>
    void leaf(const Instruction& i, const Place<Number>& place, Jet<Number>& out) {
        if (i.op == Op::constant) {
            if constexpr (std::is_same_v<Number, double>) {
                out.value = i.nearest;
            } else {
                out.value = i.enclosure;
            }
            return;
        }
        const int axis = static_cast<int>(i.op) - static_cast<int>(Op::x);
        out.value = place[axis];
        out.gradient[axis] = Number(1.0);
    }

    static bool has(std::uint8_t mask, int bit) { return ((mask >> bit) & 1) != 0; }

    template <int Order>
    static Outer outer(const Instruction& i, const Jet<Number>& a) {
        using interval::cos, interval::cosh, interval::exp, interval::log, interval::sin, interval::sinh,
            interval::sqrt, interval::tan, interval::tanh, interval::atan;
        using std::cos, std::cosh, std::exp, std::log, std::sin, std::sinh, std::sqrt, std::tan, std::tanh, std::atan;
        const Number one(1.0), two(2.0);
        const Number& u = a.value;
        Outer f;
        f.value = apply(i.op, u, u, i.exponent);
        if constexpr (Order == 0) return f;
        switch (i.op) {
            case Op::power: {
                const double n = i.exponent;
                f.slope = i.exponent == 2 ? two * u : Number(n) * power(u, i.exponent - 1);
                if (Order == 2) f.bend = i.exponent == 2 ? two : Number(n * (n - 1)) * power(u, i.exponent - 2);
                break;
            }
            case Op::square_root:
                f.slope = Number(0.5) / f.value;
                if (Order == 2) f.bend = -(f.slope / (two * u));
                break;
            case Op::exp:
                f.slope = f.bend = f.value;
                break;
            case Op::log:
                f.slope = one / u;
                if (Order == 2) f.bend = -(one / sqr(u));
                break;
            case Op::sin:
                f.slope = cos(u);
                f.bend = -f.value;
                break;
            case Op::cos:
                f.slope = -sin(u);
                f.bend = -f.value;
                break;
            case Op::tan:
                f.slope = one + sqr(f.value);
                f.bend = two * f.value * f.slope;
                break;
            case Op::atan:
                f.slope = one / (one + sqr(u));
                if (Order == 2) f.bend = -(two * u * sqr(f.slope));
                break;
            case Op::sinh:
                f.slope = cosh(u);
                f.bend = f.value;
                break;
            case Op::cosh:
                f.slope = sinh(u);
                f.bend = f.value;
                break;
            case Op::tanh:
                f.slope = one - sqr(f.value);
                f.bend = -(two * f.value * f.slope);
                break;
            default:
                break;
        }
        return f;
    }

    template <int Order>
    void unary(const Instruction& i, const Jet<Number>& a, Jet<Number>& out) {
        if (i.op == Op::negate) {
            out.value = -a.value;
            for (int k = 0; Order >= 1 && k < 3; ++k) {
                if (has(i.gradient, k)) out.gradient[k] = -a.gradient[k];
            }
            for (int k = 0; Order >= 2 && k < 6; ++k) {
                if (has(i.hessian, k)) out.hessian[k] = -a.hessian[k];
            }
            return;
        }
        chain<Order>(i, outer<Order>(i, a), tape_->instructions()[i.first], a, out);
    }

    /// Chain rule for f(a).
    template <int Order>
    static void chain(const Instruction& i, const Outer& f, const Instruction& inner, const Jet<Number>& a,
                      Jet<Number>& out) {
        out.value = f.value;
        for (int k = 0; Order >= 1 && k < 3; ++k) {
            if (has(i.gradient, k)) out.gradient[k] = f.slope * a.gradient[k];
        }
        for (int k = 0; Order >= 2 && k < 3; ++k) {
            for (int l = k; l < 3; ++l) {
                const int h = hessian_index[k][l];
                if (!has(i.hessian, h)) continue;
                Number sum(0.0);
                const bool bends = has(inner.gradient, k) && has(inner.gradient, l);
                if (bends) sum = f.bend * (k == l ? sqr(a.gradient[k]) : a.gradient[k] * a.gradient[l]);
                if (has(inner.hessian, h)) {
                    const Number part = f.slope * a.hessian[h];
                    sum = bends ? sum + part : part;
                }
                out.hessian[h] = sum;
            }
        }
    }

    template <int Order>
    void binary(const Instruction& i, const Jet<Number>& a, const Jet<Number>& b, Jet<Number>& out) {
        const Instruction &first = tape_->instructions()[i.first], &second = tape_->instructions()[i.second];
        switch (i.op) {
            case Op::add:
            case Op::subtract:
                linear<Order>(i, first, second, a, b, out);
                break;
            case Op::multiply:
                product<Order>(i, first, second, a, b, out);
                break;
            case Op::divide:
                ratio<Order>(i, first, second, a, b, out);
                break;
            default: {  // real_power, constant exponent e: e a^(e-1), e (e-1) a^(e-2)
                Outer f;
                const Number e = b.value, one(1.0);
                f.value = power(a.value, e);
                if (Order >= 1) f.slope = e * power(a.value, e - one);
                if (Order >= 2) f.bend = e * (e - one) * power(a.value, e - one - one);
                chain<Order>(i, f, first, a, out);
            }
        }
    }

    /// a or b or a op b, leaving out what is known to be 0.
    template <class Operation>
    static Number combine(bool has_a, const Number& a, bool has_b, const Number& b, Operation both, bool negative_b) {
        if (has_a && has_b) return both(a, b);
        if (has_a) return a;
        return negative_b ? -b : b;
    }

    template <int Order>
    static void linear(const Instruction& i, const Instruction& first, const Instruction& second, const Jet<Number>& a,
                       const Jet<Number>& b, Jet<Number>& out) {
        const bool minus = i.op == Op::subtract;
        const auto both = [minus](const Number& p, const Number& q) { return minus ? p - q : p + q; };
        out.value = both(a.value, b.value);
        for (int k = 0; Order >= 1 && k < 3; ++k) {
            if (has(i.gradient, k))
                out.gradient[k] =
                    combine(has(first.gradient, k), a.gradient[k], has(second.gradient, k), b.gradient[k], both, minus);
        }
        for (int k = 0; Order >= 2 && k < 6; ++k) {
            if (has(i.hessian, k))
                out.hessian[k] =
                    combine(has(first.hessian, k), a.hessian[k], has(second.hessian, k), b.hessian[k], both, minus);
        }
    }

    template <int Order>
    static void product(const Instruction& i, const Instruction& first, const Instruction& second, const Jet<Number>& a,
                        const Jet<Number>& b, Jet<Number>& out) {
        const auto plus = [](const Number& p, const Number& q) { return p + q; };
        out.value = a.value * b.value;
        for (int k = 0; Order >= 1 && k < 3; ++k) {
            if (!has(i.gradient, k)) continue;
            const bool in_a = has(first.gradient, k), in_b = has(second.gradient, k);
            out.gradient[k] = combine(in_a, in_a ? a.gradient[k] * b.value : Number(0.0), in_b,
                                      in_b ? a.value * b.gradient[k] : Number(0.0), plus, false);
        }
        for (int k = 0; Order >= 2 && k < 3; ++k) {
            for (int l = k; l < 3; ++l) {
                const int h = hessian_index[k][l];
                if (!has(i.hessian, h)) continue;
                Number sum(0.0);
                bool started = false;
                const auto add = [&](const Number& part) {
                    sum = started ? sum + part : part;
                    started = true;
                };
                if (has(first.hessian, h)) add(a.hessian[h] * b.value);
                if (has(second.hessian, h)) add(a.value * b.hessian[h]);
                if (has(first.gradient, k) && has(second.gradient, l)) add(a.gradient[k] * b.gradient[l]);
                if (has(first.gradient, l) && has(second.gradient, k)) add(a.gradient[l] * b.gradient[k]);
                out.hessian[h] = sum;
            }
        }
    }

    /// q = a / b: q_k = (a_k - q b_k) / b, q_kl = (a_kl - q_k b_l - q_l b_k - q b_kl) / b.
    template <int Order>
    static void ratio(const Instruction& i, const Instruction& first, const Instruction& second, const Jet<Number>& a,
                      const Jet<Number>& b, Jet<Number>& out) {
        out.value = a.value / b.value;
        for (int k = 0; Order >= 1 && k < 3; ++k) {
            if (!has(i.gradient, k)) continue;
            Number sum = has(first.gradient, k) ? a.gradient[k] : Number(0.0);
            if (has(second.gradient, k)) sum = sum - out.value * b.gradient[k];
            out.gradient[k] = sum / b.value;
        }
        for (int k = 0; Order >= 2 && k < 3; ++k) {
            for (int l = k; l < 3; ++l) {
                const int h = hessian_index[k][l];
                if (!has(i.hessian, h)) continue;
                Number sum = has(first.hessian, h) ? a.hessian[h] : Number(0.0);
                if (has(i.gradient, k) && has(second.gradient, l)) sum = sum - out.gradient[k] * b.gradient[l];
                if (has(i.gradient, l) && has(second.gradient, k)) sum = sum - out.gradient[l] * b.gradient[k];
                if (has(second.hessian, h)) sum = sum - out.value * b.hessian[h];
                out.hessian[h] = sum / b.value;
            }
        }
    }

    const Tape* tape_;
    std::vector<Jet<Number>> jets_;
};

}  // namespace certa::expression
