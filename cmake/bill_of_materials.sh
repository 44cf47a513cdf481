#!/usr/bin/env bash
# Lists the libraries that a program links, from the packages of the machine: package, version, licence, and
# whether the program links the library directly, through another library, or contains code of its headers.
#
#   cmake/bill_of_materials.sh PROGRAM [HEADER-ONLY PACKAGE...]
set -euo pipefail
program=$1
shift

licences() {
  sed -n 's/^License: *//p' "/usr/share/doc/$1/copyright" 2>/dev/null | sort -u | head -6 | paste -sd '|' | sed 's/|/, /g'
}
package_of() {
  { dpkg-query -S "$(realpath "$1")" || dpkg-query -S "$1" || dpkg-query -S "${1#/usr}" || dpkg-query -S "$(realpath "$1" | sed 's,^/usr,,')"; } 2>/dev/null |
    sed -n '1s/:.*//p'
}
row() { printf '%-28s %-28s %-9s %s\n' "$1" "$(dpkg-query -W -f='${Version}' "$1" 2>/dev/null | head -c 28)" "$2" "$(licences "$1")"; }

named=$(objdump -p "$program" | awk '/NEEDED/ {print $2}')
printf '%-28s %-28s %-9s %s\n' package version how licences
ldd "$program" | awk '/=> \// {print $1, $3}' | while read -r name path; do
  package=$(package_of "$path") || true
  how=loaded
  grep -qxF "$name" <<<"$named" && how=linked
  echo "${package:-$path} $how"
done | sort -k1,1 -k2,2 | awk '!seen[$1]++' | sort -k2,2 -k1,1 | while read -r package how; do row "$package" "$how"; done
for package in "$@"; do row "$package" headers; done
