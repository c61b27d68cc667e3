#pragma once
// The tree behind Expression: immutable nodes, shared by pointers, made by make_node only.
#include <certa/implicit.h>

#include <memory>
#include <vector>

#include "expression/constant.h"

namespace certa::expression {

enum class Op : unsigned char {
    constant,
    pi,
    x,
    y,
    z,
    negate,
    add,
    subtract,
    multiply,
    divide,
    power,       ///< integer exponent
    real_power,  ///< constant exponent, base > 0
    square_root,
    exp,
    log,
    sin,
    cos,
    tan,
    atan,
    sinh,
    cosh,
    tanh,
};
/// 0, 1 or 2; real_power has its exponent as second operand, power has it as a number.
inline int operand_count(Op op) {
    if (op <= Op::z) return 0;
    return (op >= Op::add && op <= Op::divide) || op == Op::real_power ? 2 : 1;
}
/// As written in expressions: "+", "sin", ...
const char* symbol_of(Op op);

using NodePointer = std::shared_ptr<const Node>;

class Node {
public:
    Op op = Op::constant;
    bool depends_on_place = false;  ///< some variable lies below
    int exponent = 0;               ///< of Op::power
    Constant constant;              ///< of Op::constant
    NodePointer first, second;

    Node() = default;
    Node(const Node&) = default;
    Node& operator=(const Node&) = delete;
    /// Takes long chains apart without recursion.
    ~Node();
};

NodePointer make_constant(Constant constant);
NodePointer make_leaf(Op op);
/// Operations on exact rationals are carried out where the result fits; nothing else is changed.
NodePointer make_unary(Op op, NodePointer a);
NodePointer make_binary(Op op, NodePointer a, NodePointer b);
NodePointer make_power(NodePointer a, int exponent);

/// base ^ exponent for a constant exponent: integer power, square root or real power. Null when it is not constant.
NodePointer make_constant_power(const NodePointer& base, const NodePointer& exponent);

/// An enclosure of a node without variables (undefined where it has no value).
interval::Interval enclosure_of_constant(const NodePointer& node);

/// Every node below the root once, operands before what uses them. No recursion.
std::vector<const Node*> in_order(const NodePointer& root);

}  // namespace certa::expression
