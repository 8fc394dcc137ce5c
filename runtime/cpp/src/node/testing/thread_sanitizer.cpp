// SPDX-License-Identifier: Apache-2.0
// What the thread sanitizer must not report of libraries that are not built for it. Exceptions are
// counted in the standard library: it does not see that the last thread to release one comes last.
// Nor does it see that OpenSSL reads what it has cached of a certificate after an atomic flag.
#if defined(__SANITIZE_THREAD__)
// Its library finds what the program shows.
extern "C" [[gnu::visibility("default")]] const char*
__tsan_default_suppressions() {  // NOLINT: its name
  return "race:std::__exception_ptr::exception_ptr::_M_release\n"
         "race:ASN1_STRING_cmp\n";
}
#endif
