"""Words of C and C++: keywords, functions and macros of the systems where the generated C is built.

Gathered from the headers of glibc, newlib and picolibc, with those of microcontrollers, Windows and Qt; a macro of one
header spoils a struct member of the same name in another. Families are given by patterns.
"""

from __future__ import annotations

import re

from symgen.backends.c.endings import BATCH, PREPARED, SINES_GIVEN
from symgen.registered import Words, words

_C = """auto break case char const continue default do double else enum extern float for goto if inline int long
register restrict return short signed sizeof static struct switch typedef union unsigned void volatile while"""
_CPP = """alignas alignof and and_eq asm bitand bitor bool catch char8_t char16_t char32_t class co_await co_return
co_yield compl concept const_cast consteval constexpr constinit decltype delete dynamic_cast explicit export false
friend mutable namespace new noexcept not not_eq nullptr operator or or_eq private protected public reinterpret_cast
requires static_assert static_cast template this thread_local throw true try typeid typename using virtual wchar_t xor
xor_eq"""
KEYWORDS = {
    **dict.fromkeys(_CPP.split(), "a keyword of C++"),
    **dict.fromkeys(_C.split(), "a keyword of C"),
}
# Keywords of some compilers or places only.
_SOMETIMES = words("fortran typeof complex imaginary final override import module")
_MATH_FUNCTIONS = words(
    """acos acosh asin asinh atan atan2 atanh cbrt ceil copysign cos cosh erf erfc exp exp2 expm1 fabs fdim floor fma
    fmax fmin fmod frexp hypot ilogb ldexp lgamma llrint llround log log10 log1p log2 logb lrint lround modf nan
    nearbyint nextafter nexttoward pow remainder remquo rint round scalbln scalbn sin sinh sqrt tan tanh tgamma
    trunc sincos exp10 pow10 drem gamma significand scalb finite j0 j1 jn y0 y1 yn"""
)
LIBRARY_NAMES = frozenset(name + suffix for name in _MATH_FUNCTIONS for suffix in ("", "f", "l")) | words(
    """memchr memcmp memcpy memmove memset strcat strchr strcmp strcoll strcpy strcspn strerror strlen strncat strncmp
    strncpy strpbrk strrchr strspn strstr strtok strxfrm
    abs labs llabs div ldiv lldiv abort exit atexit malloc calloc realloc free signgam isfinite isinf isnan isnormal
    signbit fpclassify isgreater isless isunordered INFINITY NAN HUGE_VAL NULL EOF errno assert offsetof stdin
    stdout stderr main size_t ptrdiff_t int8_t int16_t int32_t int64_t uint8_t uint16_t uint32_t uint64_t float_t
    double_t RAND_MAX EXIT_SUCCESS EXIT_FAILURE BUFSIZ CHAR_BIT DOMAIN SING OVERFLOW UNDERFLOW PLOSS TLOSS HUGE
    MAXFLOAT M_E M_LOG2E M_LOG10E M_LN2 M_LN10 M_PI M_PI_2 M_PI_4 M_1_PI M_2_PI M_2_SQRTPI M_SQRT2 M_SQRT1_2 FP_NAN
    FP_INFINITE FP_ZERO FP_SUBNORMAL FP_NORMAL"""
)
# complex.h, POSIX and Windows
PLATFORM_MACROS = words(
    """I linux unix i386 near far small hyper interface min max major minor CONST VOID TRUE FALSE BOOL IN OUT OPTIONAL
    ERROR DELETE"""
)
ARDUINO_MACROS = (
    words(
        """F HIGH LOW INPUT OUTPUT INPUT_PULLUP PI HALF_PI TWO_PI DEG_TO_RAD RAD_TO_DEG EULER SERIAL DISPLAY LSBFIRST
        MSBFIRST CHANGE FALLING RISING DEFAULT EXTERNAL INTERNAL constrain radians degrees sq interrupts noInterrupts
        lowByte highByte bit bitRead bitSet bitClear bitWrite word boolean byte cli sei SP SS SCK MOSI MISO SDA SCL
        LED_BUILTIN"""
    )
)
# Macros of complex.h, POSIX, the C libraries and their extensions that no pattern below covers.
_HEADER_MACROS = words(
    """BS0 BS1 CR0 CR1 CR2 CR3 CS5 CS6 CS7 CS8 EIO EOF ERA FF0 FF1 F_OK HZ MAX MIN NCC NL0 NL1 NO R_OK TAB0 TAB1 TAB2
    TAB3 VT0 VT1 W_OK X_OK YES L_ctermid L_cuserid L_tmpnam P_tmpdir Nil nil alloca assert_perror basename carg
    cimag clearerr clearerr_unlocked clearerror clrbit conj cproj creal d_fileno dadd ddiv dfma dmul dsqrt dsub fadd
    fast_putc fd_set fdev_close fdev_setup_stream fdiv fds_bits feof feof_unlocked ferror ferror_unlocked ffma
    fmaximum fmaximum_mag fmaximum_mag_num fmaximum_num fmaxmag fminimum fminimum_mag fminimum_mag_num fminimum_num
    fminmag fmul fropen fsqrt fsub fwopen getc getchar getchar_unlocked getwc getwc_unlocked getwchar
    getwchar_unlocked h_addr h_errno howmany isclr iseqsig islessequal islessgreater isset issignaling issubnormal
    iszero iszerof isgreaterequal kill_dependency llogb makedev math_errhandling msg_cbytes nextdown nextup
    no_argument noreturn optional_argument physadr powerof2 printf_float putc putchar putchar_unlocked putwc
    putwc_unlocked putwchar putwchar_unlocked quad required_argument roundeven roundup sa_handler sa_sigaction
    sched_priority setbit setjmp sigaddset sigdelset sigemptyset sigfillset sigismember sigmask sigsetjmp strdupa
    strndupa strtodf toascii toascii_l tolower toupper tzname va_arg va_copy va_end va_start isfinitef isinff isnanf
    isnormalf forever foreach emit signals slots likely unlikely pascal cdecl huge mips sun sparc"""
)
# Registers and pins of microcontrollers, as their makers' headers define them.
_PERIPHERALS = (
    "ADC|AES|CAN|CRC|DAC|DCMI|DMA|DWT|ETH|EXTI|FMC|FPU|GPIO|I2C|I2S|INT|IRQ|ITM|LCD|MPU|MUX|NVIC|OTG|PIN|PIO|PORT|PWM|"
    "PWR|QSPI|RCC|RNG|RTC|SAI|SCB|SPI|SYS|TIM|TPI|TWI|UART|USART|USB|WDT"
)
_MACRO_PATTERNS = re.compile(
    r"(?=(?:[^A-Z]*[A-Z]){4})[A-Z0-9_]*[A-Z0-9]"  # four capitals and no small letter: DBL_EPSILON, BIG_ENDIAN, EPERM
    r"|[AB]\d+|CS\d\d|SM\d|P[A-K]\d+|PIN[A-L]\d|DD[A-L]\d|DDR[A-L]|COM\d\w*|TOV\d|OCF\d\w|WGM\d+"
    rf"|(?:{_PERIPHERALS})\d*[A-Z]?|BIT\d*|(?:DAY|MON)_\d+"
    r"|M_(?:E|PI|PI_2|PI_4|3PI_4|TWOPI|SQRTPI|[12]_PI|2_SQRTPI|SQRT2|SQRT3|SQRT1_2|LN2|LN10|LN2HI|LN2LO|LOG2_?E|LOG10E)"
    r"(?:f|l|[fF]\d+x?)?|(?:AF|PF|N)_(?:AX25|X25|R3964|DECnet)"
    r"|(?:PRI|SCN)[dioux](?:FAST|LEAST)?(?:\d+|MAX|PTR)|u?fromfpx?|f(?:32|64)x?(?:add|div|fma|mul|sqrt|sub)"
    r"|(?:be|le)\d+toh|hto[bl]e\d+|bswap_\d+|st_[acm]time|s6_addr\d*|timer(?:add|clear|cmp|isset|sub)"
    r"|is(?:alnum|alpha|ascii|blank|canonical|cntrl|digit|graph|lower|print|punct|space|upper|xdigit)(?:_l)?"
    r"|(?:obstack|pthread|atomic|ifr|ifa|ifc|sigev|bintime)_[a-z]\w*|timespec[a-z]+"
    r"|si_(?:addr|addr_lsb|arch|band|call_addr|fd|int|lower|overrun|pid|pkey|ptr|status|stime|syscall|timerid|uid|upper"
    r"|utime|value)"
)
_TAKEN = frozenset(KEYWORDS) | _SOMETIMES | LIBRARY_NAMES | PLATFORM_MACROS | ARDUINO_MACROS | _HEADER_MACROS

# Headers that the generated files, or what is built beside them, look for by these names.
_HEADERS = words(
    """aio alloca argz assert byteswap complex cpio ctype dirent dlfcn elf endian envz err errno error execinfo fcntl
    fenv float fnmatch getopt glob grp iconv inttypes iso646 langinfo libgen limits link locale malloc math memory
    monetary netdb poll pthread pwd regex sched search semaphore setjmp signal spawn stdalign stdarg stdatomic
    stdbool stdckdint stdbit stddef stdint stdio stdlib stdnoreturn string strings syslog sysexits tar termios
    tgmath threads time uchar ucontext ulimit unistd utime utmpx values wait wchar wctype windows arduino binary
    eeprom print printable sd servo spi stepper stream udp wifi wire main sdkconfig freertos board"""
)
# Targets of CMake and Zephyr, and libraries that linkers look for by a short name.
_TARGETS = words(
    """all all_build clean depend edit_cache help install list_install_components package package_source preinstall
    rebuild_cache run_tests test zero_check app kernel zephyr offsets linker c m gcc gcc_s rt dl pthread util ssp
    nosys semihost crt0 g gloss winpthread mingw32 msvcrt kernel32 user32 atomic"""
)
_WINDOWS_FILES = words("con prn aux nul") | {f"{port}{k}" for port in ("com", "lpt") for k in range(10)}
# Macros and enumerators in capitals such as R_OK of unistd.h, HAL_OK, ESP_OK of makers, Z_OK, FR_OK of libraries.
_STATUSES = words("always err esp ex f force fr hal lfs nvs pm psa r res sqlite static tcl tx w x z")


def is_taken(name: str) -> bool:
    """Whether a name is taken where the generated C may be built; with enough underscores behind it none is."""
    return name in _TAKEN or (name[-1] != "_" and _MACRO_PATTERNS.fullmatch(name) is not None)


# Of files (eva, fuzz and error are drivers for proofs), and how functions begin behind the model's name.
_ENDINGS = frozenset(ending[1:] for ending in (BATCH, PREPARED, SINES_GIVEN)) | words(
    """f eva fuzz error
    default actuator minimal projected weighted inverse_dynamics forward_dynamics multipliers"""
)
WORDS = Words(KEYWORDS, is_taken, _HEADERS | _TARGETS | _WINDOWS_FILES | _STATUSES, _ENDINGS)
