#!/bin/bash
# What a program can link to in the library is what the list says: a line that goes or changes needs another SOVERSION, a new
# one only another list. usage: shown_symbols.sh LIBRARY LIST
set -euo pipefail
diff <(sort "$2") <(nm --dynamic --defined-only --demangle "$1" | cut -d' ' -f3- | grep -v '^EDGESLAM_1' | sed 's/@@.*//' | sort -u) ||
  { echo "the library shows something else than $2 says"; exit 1; }
