#pragma once
// What `implicit` and `check` share about implicit surfaces.
#include <certa/implicit.h>

#include <string>

#include "report.h"
#include "session.h"

namespace certa::cli {

/// The text of a function: a file's where the argument names one ("-": standard input), else the argument itself.
struct FunctionArgument {
    std::string text;  ///< as given on the command line
    struct Source {
        std::string name, text;
    };
    Source read() const;
};

/// Reads a text file whole ("-": standard input). Errors: IoError.
std::string read_text(const std::string& path);

Json to_json(const ImplicitCheck& check);

/// Verifies a surface mesh against a function by a certificate; says and reports what was found.
ExitCode check_implicit_mesh(Session& session, const MeshDocument& document, const FunctionArgument& function,
                             const std::string& certificate);

/// Decides what a surface mesh made by any program is to the zero set of a function in a box (empty: around the mesh).
ExitCode check_mesh_against_function(Session& session, const MeshDocument& document, const FunctionArgument& function,
                                     const std::vector<double>& box);

}  // namespace certa::cli
