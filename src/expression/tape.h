#pragma once
// A function as a straight line of instructions: simplified, every common part once, with the sparsity of its
// derivatives.
#include <certa/implicit.h>

#include <atomic>
#include <cstdint>
#include <memory>
#include <vector>

#include "expression/node.h"
#include "interval/interval.h"

namespace certa::expression {

/// Bits of `hessian` masks: the second derivatives xx, xy, xz, yy, yz, zz.
inline constexpr int hessian_index[3][3] = {{0, 1, 2}, {1, 3, 4}, {2, 4, 5}};

struct Instruction {
    Op op = Op::constant;
    std::uint8_t gradient = 0;  ///< bit i: the derivative by variable i may differ from 0
    std::uint8_t hessian = 0;   ///< likewise for second derivatives
    int exponent = 0;           ///< of Op::power
    std::uint32_t first = 0;    ///< indices of earlier instructions
    std::uint32_t second = 0;
    interval::Interval enclosure;  ///< of Op::constant
    double nearest = 0.0;          ///< of Op::constant
};

/// Immutable; the last instruction is the function. Threads may share one, each with its own workspace (jet.h).
class Tape {
public:
    /// Definition: the same real function as the tree wherever the tree is defined, and undefined wherever it is not:
    ///             simplification never drops an operand that may be undefined.
    explicit Tape(const Expression& function);

    const std::vector<Instruction>& instructions() const { return instructions_; }
    std::size_t size() const { return instructions_.size(); }

    /// Statistics: how many enclosures were computed with this tape and its copies, as their evaluators report.
    std::uint64_t enclosures() const { return enclosures_->load(); }
    void count_enclosures(std::uint64_t more) const { *enclosures_ += more; }

private:
    friend class TapeBuilder;
    std::vector<Instruction> instructions_;
    std::shared_ptr<std::atomic<std::uint64_t>> enclosures_ = std::make_shared<std::atomic<std::uint64_t>>(0);
};

}  // namespace certa::expression
