// The canonical text of an expression: one definition per operation, in the order of evaluation, the function last.
// Nothing is nested, so neither depth nor sharing makes the text longer than the tree has nodes.
#include <string>
#include <unordered_map>

#include "expression/node.h"

namespace certa {

std::string format_expression(const Expression& function) {
    using namespace expression;
    std::unordered_map<const Node*, std::string> names;
    std::string text;
    int count = 0;
    for (const Node* node : in_order(function.node())) {
        std::string formula;
        const int operands = operand_count(node->op);
        if (node->op == Op::constant) {
            names[node] = text_of(node->constant);
            continue;
        }
        if (operands == 0) {
            names[node] = symbol_of(node->op);
            continue;
        }
        const std::string& a = names.at(node->first.get());
        if (node->op == Op::power) {
            formula = a + "^" + std::to_string(node->exponent);
        } else if (operands == 2) {
            formula = a + " " + symbol_of(node->op) + " " + names.at(node->second.get());
        } else if (node->op == Op::negate) {
            formula = "-" + a;
        } else {
            formula = symbol_of(node->op) + ("(" + a + ")");
        }
        names[node] = "t" + std::to_string(++count);
        text += names[node] + " = " + formula + "\n";
    }
    return text + names.at(function.node().get()) + "\n";
}

}  // namespace certa
