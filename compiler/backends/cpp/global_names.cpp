// SPDX-License-Identifier: Apache-2.0
// Names of the global namespace that the first segment of a service must not meet: what the headers
// of C, C++ and POSIX declare there that the runtime includes, and std itself.
#include <cstddef>
#include <string_view>
#include <unordered_set>

#include "compiler/backends/cpp/names.hpp"

namespace robdef::cpp {
namespace {

// Each between blanks.
constexpr std::string_view global_names =
    " "
    "abort abs accept accept4 access acct acos acosh addrinfo adjtime alarm alloca asctime asin "
    "asinh asprintf atan atan2 atanh atexit atof atoi atol basename bcmp bcopy bind bindresvport "
    "bindresvport6 brk bsearch btowc bzero calloc canonicalize cbrt ceil chdir chmod chown chroot "
    "clearenv clearerr clock clone close closefrom cmsghdr confstr connect copysign cos cosh "
    "creat crypt ctermid ctime cuserid daddl daemon daylight ddivl dfmal difftime div dmull "
    "dprintf drand48 drem dsqrtl dsubl dup dup2 dup3 duplocale dysize eaccess ecvt endhostent "
    "endnetent endnetgrent endprotoent endrpcent endservent endusershell environ erand48 erf erfc "
    "euidaccess eventfd execl execle execlp execv execve execveat execvp execvpe exit exp exp10 "
    "exp2 expm1 fabs faccessat fadd fallocate fchdir fchmod fchmodat fchown fchownat fclose "
    "fcloseall fcntl fcvt fdatasync fdim fdiv fdopen feof ferror fexecve fflush ffma ffs fgetc "
    "fgetpos fgets fgetwc fgetws fileno finite flock flockfile floor fma fmax fmaximum fmaxmag "
    "fmemopen fmin fminimum fminmag fmod fmul fopen fopencookie fork fpathconf fprintf fputc "
    "fputs fputwc fputws fread free freeaddrinfo freelocale freopen frexp fromfp fromfpx fscanf "
    "fseek fseeko fsetpos fsqrt fstat fstatat fsub fsync ftell ftello ftruncate ftrylockfile "
    "funlockfile futimens futimes futimesat fwide fwprintf fwrite fwscanf gaicb gamma gcvt "
    "getaddrinfo getc getchar getcpu getcwd getdate getdelim getdomainname getdtablesize getegid "
    "getentropy getenv geteuid getgid getgroups gethostbyaddr gethostbyname gethostbyname2 "
    "gethostent gethostid gethostname getitimer getline getloadavg getlogin getnameinfo "
    "getnetbyaddr getnetbyname getnetent getnetgrent getopt getpagesize getpass getpayload "
    "getpeername getpgid getpgrp getpid getppid getprotobyname getprotobynumber getprotoent getpt "
    "getresgid getresuid getrpcbyname getrpcbynumber getrpcent getservbyname getservbyport "
    "getservent getsid getsockname getsockopt getsourcefilter getsubopt gettid gettimeofday "
    "getuid getumask getusershell getw getwc getwchar getwd gmtime grantpt gsignal herror hostent "
    "hstrerror htonl htons hypot iface ifaddr ifconf ifmap ifreq ilogb index initstate innetgr "
    "ioctl iovec iruserok isalnum isalpha isascii isatty isblank iscanonical iscntrl isctype "
    "isdigit iseqsig isfdtype isgraph isinff isinfl islower isnanf isnanl isprint ispunct "
    "issignaling isspace isupper iswalnum iswalpha iswblank iswcntrl iswctype iswdigit iswgraph "
    "iswlower iswprint iswpunct iswspace iswupper iswxdigit isxdigit iszero itimerspec itimerval "
    "j0 j1 jn jrand48 kill killpg labs lchmod lchown lcong48 lconv ldexp ldiv lgamma linger link "
    "linkat listen llabs lldiv llogb llrint llround localeconv localtime lockf log log10 log2 "
    "logb lrand48 lrint lround lseek lstat lutimes malloc mblen mbrlen mbrtowc mbsinit mbsnrtowcs "
    "mbsrtowcs mbstowcs mbtowc memccpy memchr memcmp memcpy memfrob memmem memmove mempcpy "
    "memrchr memset mkdir mkdirat mkdtemp mkfifo mkfifoat mknod mknodat mkostemp mkostemps "
    "mkstemp mkstemps mktemp mktime mmsghdr modf mrand48 msghdr nan nanosleep nearbyint netent "
    "newlocale nextafter nextdown nexttoward nextup nice nrand48 ntohl ntohs obstack open openat "
    "optarg opterr optind optopt osockaddr pathconf pause pclose perror pipe pipe2 poll pollfd "
    "popen posix pow ppoll pread preadv preadv2 printf profil protoent pselect psiginfo psignal "
    "ptsname putc putchar putenv puts putw putwc putwchar pwrite pwritev pwritev2 qecvt qfcvt "
    "qgcvt qsort raise rand random rawmemchr rcmd read readahead readlink readlinkat readv "
    "realloc reallocarray realpath recv recvfrom recvmmsg recvmsg remainder remove remquo rename "
    "renameat renameat2 revoke rewind rexec rindex rint rmdir round roundeven rpcent rpmatch "
    "rresvport ruserok sbrk scalb scalbln scalbn scanf seed48 select send sendmmsg sendmsg sendto "
    "servent setbuf setbuffer setdomainname setegid setenv seteuid setgid sethostent sethostid "
    "sethostname setitimer setlinebuf setlocale setlogin setnetent setnetgrent setns setpayload "
    "setpayloadsig setpgid setpgrp setprotoent setregid setresgid setresuid setreuid setrpcent "
    "setservent setsid setsockopt setsourcefilter setstate settimeofday setuid setusershell "
    "setvbuf shutdown sigaction sigaddset sigaltstack sigandset sigblock sigcontext sigdelset "
    "sigemptyset sigevent sigfillset siggetmask sighold sigignore siginterrupt sigisemptyset "
    "sigismember signal signgam significand sigorset sigpause sigpending sigprocmask sigqueue "
    "sigrelse sigreturn sigset sigsetmask sigstack sigsuspend sigtimedwait sigval sigwait "
    "sigwaitinfo sin sincos sinh sleep snprintf sockaddr sockatmark socket socketpair splice "
    "sprintf sqrt srand srand48 srandom sscanf ssignal stat std strcat strlen system tan tanh "
    "time timezone tm trunc wait write y0 y1 yn ";

}  // namespace

bool is_global_name(std::string_view word) {
  static const std::unordered_set<std::string_view> names = [] {
    std::unordered_set<std::string_view> all;
    for (std::string_view rest = global_names.substr(1); !rest.empty();) {
      const std::size_t end = rest.find(' ');
      all.insert(rest.substr(0, end));
      rest.remove_prefix(end + 1);
    }
    return all;
  }();
  return names.contains(word);
}

}  // namespace robdef::cpp
