#pragma once
// What each format can carry, in one table; documents that hold more are refused before a byte is written.
#include <certa/io.h>

#include <string>

namespace certa::io {

/// Fails unless the arrays of a document fit together: offsets, indices, sizes of markers and fields, finite numbers.
/// `name` stands for the document in the message.
void check_consistent(const MeshDocument& document, const std::string& name);

/// Fails, naming a format that can, if `format` cannot carry all that the document holds.
void check_writable(const MeshDocument& document, Format format, const WriteOptions& options, const std::string& name);

}  // namespace certa::io
