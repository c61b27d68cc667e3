// The manual page and the shell completion, from the parser's own tables: what --help says, they say.
//
// `certa manual` and `certa completion` print them; the installation runs both. Neither is listed by --help: they are
// for those who build packages.
#include "manual.h"

#include <algorithm>
#include <vector>

namespace certa::cli {
namespace {

/// Text that roff prints as it is.
std::string escaped(const std::string& text) {
    std::string result;
    for (std::size_t i = 0; i < text.size(); ++i) {
        const char c = text[i];
        const bool starts_line = i == 0 || text[i - 1] == '\n';
        if (starts_line && (c == '.' || c == '\'')) result += "\\&";
        if (c == '\\') {
            result += "\\e";
        } else if (c == '-') {
            result += "\\-";
        } else {
            result += c;
        }
    }
    return result;
}

std::vector<const CLI::App*> listed_commands(const CLI::App& app) {
    std::vector<const CLI::App*> commands;
    for (const CLI::App* command : app.get_subcommands([](const CLI::App*) { return true; })) {
        if (!command->get_group().empty()) commands.push_back(command);
    }
    return commands;
}

std::string first_line(const std::string& text) { return text.substr(0, text.find('\n')); }

void add_option(std::string& page, const CLI::Option& option) {
    page += ".TP\n.B " + escaped(option.get_positional() ? option.get_name(true) : option.get_name(false, true)) + '\n';
    // A positional's name says it all.
    if (!option.get_positional() && option.get_expected_max() > 0) {
        page.pop_back();
        page += " \\fI" + escaped(option.get_type_name()) + "\\fR\n";
    }
    page += escaped(option.get_description()) + '\n';
}

void add_command(std::string& page, const CLI::App& command) {
    page += ".SS certa " + command.get_name() + '\n' + escaped(command.get_description()) + '\n';
    for (const CLI::Option* option : command.get_options()) {
        if (option->get_name() != "--help") add_option(page, *option);
    }
    const std::string footer = command.get_footer();
    if (!footer.empty()) page += ".PP\n.nf\n" + escaped(footer) + "\n.fi\n";
}

}  // namespace

std::string manual_page(const CLI::App& app, const std::string& version) {
    std::string page = ".TH CERTA 1 \"\" \"certa " + version + "\" \"User Commands\"\n.SH NAME\n";
    std::string description = first_line(app.get_description());
    if (const std::size_t colon = description.find(": "); colon != std::string::npos) {
        description = description.substr(colon + 2);
    }
    page += "certa \\- " + escaped(description) + "\n.SH SYNOPSIS\n.B certa\n\\fICOMMAND\\fR [\\fIOPTIONS\\fR]\n";
    page += ".SH COMMANDS\n";
    for (const CLI::App* command : listed_commands(app)) add_command(page, *command);
    page += ".SH NOTES\n.nf\n" + escaped(app.get_footer()) + "\n.fi\n";
    return page;
}

std::string bash_completion(const CLI::App& app) {
    std::string names, cases;
    for (const CLI::App* command : listed_commands(app)) {
        names += (names.empty() ? "" : " ") + command->get_name();
        std::string flags, choices;
        for (const CLI::Option* option : command->get_options()) {
            for (const std::string& name : option->get_lnames()) {
                flags += (flags.empty() ? "--" : " --") + name;
                std::string values = option->get_type_name();
                if (values.find('|') == std::string::npos) continue;
                std::replace(values.begin(), values.end(), '|', ' ');
                choices += "                --" + name + ") values=\"" + values + "\" ;;\n";
            }
        }
        cases += "        " + command->get_name() + ")\n            flags=\"" + flags + "\"\n";
        if (!choices.empty()) cases += "            case $previous in\n" + choices + "            esac\n";
        cases += "            ;;\n";
    }
    return "# bash completion for certa\n"
           "_certa() {\n"
           "    local word=${COMP_WORDS[COMP_CWORD]} previous=${COMP_WORDS[COMP_CWORD-1]} flags values=\n"
           "    if ((COMP_CWORD == 1)); then\n"
           "        COMPREPLY=($(compgen -W \"" +
           names +
           " --help --version\" -- \"$word\"))\n"
           "        return\n"
           "    fi\n"
           "    case ${COMP_WORDS[1]} in\n" +
           cases +
           "    esac\n"
           "    if [[ -n $values ]]; then\n"
           "        COMPREPLY=($(compgen -W \"$values\" -- \"$word\"))\n"
           "    elif [[ $word == -* ]]; then\n"
           "        COMPREPLY=($(compgen -W \"$flags\" -- \"$word\"))\n"
           "    else\n"
           "        mapfile -t COMPREPLY < <(compgen -f -- \"$word\")\n"  // names may hold blanks
           "        compopt -o filenames 2>/dev/null\n"
           "    fi\n"
           "}\n"
           "complete -F _certa certa\n";
}

}  // namespace certa::cli
