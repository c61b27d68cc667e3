#pragma once
// What interval arithmetic needs from the floating-point environment of the calling thread.

namespace certa::interval {

/// Whether additions round to nearest and denormal numbers are kept: the two things that the outward step rests on.
/// False after fesetround() to another mode, and where flush-to-zero or denormals-are-zero is on (code linked with
/// -ffast-math turns them on for the whole process). Cheap; asked by every thread that is about to prove something.
bool is_environment_sound();

/// Throws InternalError, saying how it comes about, unless is_environment_sound().
void require_sound_environment();

}  // namespace certa::interval
