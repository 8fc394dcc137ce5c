// SPDX-License-Identifier: Apache-2.0
// What a MEX file for MATLAB needs besides the archives, so that it stands on none of the libraries
// that MATLAB has in other versions: all of libstdc++, OpenSSL, fmt and the ANTLR runtime is
// inside. Debian's fmt has no archive, and that of ANTLR is not made for shared objects; this file
// closes both gaps.
#include <fmt/format-inl.h>

#include <cstdlib>

FMT_BEGIN_NAMESPACE
namespace detail {
// Templates whose code is in fmt's library only.
template thousands_sep_result<char> thousands_sep_impl(locale_ref);
template char decimal_point_impl(locale_ref);
}  // namespace detail
FMT_END_NAMESPACE

// ANTLR's Parser can look for patterns in its trees, for which it would bring along character
// streams with thread-local data that a shared object cannot link. The parser of definitions does
// not: what it would call is not there. Names as the linker has them, since the classes cannot be
// declared a second time.
extern "C" {
[[noreturn]] void rr_no_pattern_matcher() asm(
    "_ZN6antlr44tree7pattern23ParseTreePatternMatcherC1EPNS_5LexerEPNS_6ParserE");
[[noreturn]] void rr_no_pattern_matcher() { std::abort(); }
[[noreturn]] void rr_no_pattern_compiled() asm(
    "_ZN6antlr44tree7pattern23ParseTreePatternMatcher7compileERKNSt7__cxx1112basic_"
    "stringIcSt11char_traitsIcESaIcEEEi");
[[noreturn]] void rr_no_pattern_compiled() { std::abort(); }
[[noreturn]] void rr_no_pattern_matcher_end() asm(
    "_ZN6antlr44tree7pattern23ParseTreePatternMatcherD1Ev");
[[noreturn]] void rr_no_pattern_matcher_end() { std::abort(); }

// The archive reads glibc's flag in a way that only programs can. Zero: there may be several
// threads.
__attribute__((visibility("hidden"),
               used)) char rr_libc_single_threaded asm("__libc_single_threaded") = 0;
}
