"""Words of Python: its keywords, and the modules that others look for."""

from __future__ import annotations

from symgen.registered import Words, words

_KEYWORDS = """False None True and as assert async await break class continue def del elif else except finally for from
global if import in is lambda nonlocal not or pass raise return try while with yield"""
KEYWORDS = dict.fromkeys(_KEYWORDS.split(), "a keyword of Python")
_MODULES = words(
    """abc aifc antigravity argparse array ast asynchat asyncio asyncore atexit audioop base64 bdb binascii bisect
    builtins bz2 calendar cgi cgitb chunk cmath cmd code codecs codeop collections colorsys compileall concurrent
    configparser contextlib contextvars copy copyreg cprofile crypt csv ctypes curses dataclasses datetime dbm
    decimal difflib dis distutils doctest email encodings ensurepip enum faulthandler filecmp fileinput fractions
    ftplib functools gc genericpath getpass gettext graphlib gzip hashlib heapq hmac html http idlelib imaplib
    imghdr imp importlib inspect io ipaddress itertools json keyword lib2to3 linecache logging lzma mailbox mailcap
    marshal mimetypes mmap modulefinder msilib msvcrt multiprocessing netrc nis nntplib nt ntpath nturl2path numbers
    numpy opcode operator optparse os ossaudiodev pathlib pdb pickle pickletools pip pipes pkg_resources pkgutil
    platform plistlib poplib posix posixpath pprint profile pstats pty py_compile pyclbr pydoc pydoc_data pyexpat
    queue quopri random re readline reprlib resource rlcompleter runpy scipy secrets select selectors setuptools
    shelve shlex shutil site smtpd smtplib sndhdr socket socketserver spwd sqlite3 sre_compile sre_constants
    sre_parse ssl stat statistics stringprep struct subprocess sunau symtable sys sysconfig tabnanny tarfile
    telnetlib tempfile test textwrap this threading timeit tkinter token tokenize tomllib trace traceback
    tracemalloc tty turtle turtledemo types typing unicodedata unittest urllib uu uuid venv warnings wave weakref
    webbrowser winreg winsound wsgiref xdrlib xml xmlrpc zipapp zipfile zipimport zlib zoneinfo"""
)
WORDS = Words(KEYWORDS, KEYWORDS.__contains__, _MODULES)
