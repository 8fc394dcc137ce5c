// SPDX-License-Identifier: Apache-2.0
// What the thread sanitizer must not report: exceptions are counted in the standard library, which
// is not built for it, so it does not see that the last thread to let go of one comes last.
#if defined(__SANITIZE_THREAD__)
// Its library finds what the program shows.
extern "C" [[gnu::visibility("default")]] const char*
__tsan_default_suppressions() {  // NOLINT: its name
  return "race:std::__exception_ptr::exception_ptr::_M_release\n";
}
#endif
