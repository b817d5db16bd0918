"""Names of functions in C."""

from __future__ import annotations

import re

from ._errors import ModelError

_WORDS = """
auto break case char const continue default do double else enum extern float for goto if inline int long register restrict return
short signed sizeof static struct switch typedef union unsigned void volatile while asm typeof bool true false nullptr constexpr
alignas alignof static_assert thread_local linux unix main
"""

# Functions of <math.h>, which are there for float and long double as well.
_MATH = """
acos asin atan atan2 cos sin tan acosh asinh atanh cosh sinh tanh exp exp2 expm1 exp10 pow10 frexp ilogb ldexp log log10 log1p log2
logb modf scalbn scalbln scalb cbrt fabs hypot pow sqrt erf erfc lgamma tgamma gamma ceil floor nearbyint rint lrint llrint round
lround llround trunc fmod remainder remquo drem copysign nan nextafter nexttoward fdim fmax fmin fma finite isinf isnan significand
sincos j0 j1 jn y0 y1 yn
"""

# Other functions and macros that a C file has.
_OTHERS = """
NULL NAN INFINITY HUGE_VAL HUGE_VALF HUGE_VALL EOF errno stdin stdout stderr casadi_real casadi_int signgam
fpclassify isfinite isnormal signbit isgreater isgreaterequal isless islessequal islessgreater isunordered
memchr memcmp memcpy memmove memset memccpy mempcpy memmem strcat strchr strcmp strcoll strcpy strcspn strerror strlen strncat strncmp
strncpy strpbrk strrchr strspn strstr strtok strxfrm strdup strndup strnlen strsep strsignal strtok_r strcasecmp strncasecmp stpcpy
stpncpy strtod strtof strtol strtold strtoll strtoul strtoull strftime index rindex bcopy bzero bcmp ffs ffsl ffsll
abort abs labs llabs atexit atof atoi atol atoll bsearch calloc div exit free getenv ldiv lldiv malloc mblen qsort rand realloc srand
system alloca clearerr fclose feof ferror fflush fgetc fgetpos fgets fopen fprintf fputc fputs fread freopen fscanf fseek fsetpos
ftell fwrite getc getchar gets perror printf putc putchar puts remove rename rewind scanf setbuf setvbuf snprintf sprintf sscanf
tmpfile tmpnam ungetc vfprintf vfscanf vprintf vscanf vsnprintf vsprintf vsscanf
isalnum isalpha isblank iscntrl isdigit isgraph islower isprint ispunct isspace isupper isxdigit tolower toupper
clock difftime mktime time asctime ctime gmtime localtime raise signal setjmp longjmp
"""

_PREFIXES = ("M_", "FP_", "MATH_", "math_")  # of the macros of <math.h>

_TAKEN = {*_WORDS.split(), *_OTHERS.split(), *(name + kind for name in _MATH.split() for kind in ("", "f", "l"))}


def refuse_c_name(name: str) -> None:
    """Raises ModelError unless a C file may define a function of this name, and TypeError if it is no text."""
    if not isinstance(name, str):
        raise TypeError(f"the name of a function in C is a text, not a {type(name).__name__}")
    if not re.fullmatch(r"[A-Za-z][A-Za-z0-9_]*", name):
        raise ModelError(f"{name!r} is no name of a function in C\nhint: letters of a to z, digits and _ make a name, and a letter begins it, as in 'motion'")
    if name in _TAKEN or name.startswith(_PREFIXES):
        raise ModelError(f"{name!r} is a word of C or of its standard library, so no function can have this name\nhint: take another one, such as '{name}_motion'")
