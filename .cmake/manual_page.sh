#!/bin/sh
# Makes a manual page of what a program says for --help; each of its jobs becomes a section of it.
# Usage: manual_page.sh PROGRAM VERSION PAGE.1.gz
set -eu
program=$1
version=$2
page=${3%.gz}
export COLUMNS=1000 # Python's argparse breaks lines, which is for the reader of the page

# The jobs that the program, or the job that the words name, knows.
jobs_of() {
  "$program" "$@" --help | sed -n '/^Subcommands:/,/^$/s/^  \([a-z][a-z-]*\) .*/\1/p'
}

# help2man takes a line between asterisks for the title of a section, "Options:" for that of the program's own, and
# "Examples:" for that of everybody's.
text_of_jobs() {
  for job in $(jobs_of "$@"); do
    printf '\n*%s %s*\n\n' "$(basename "$program")" "$(echo "$@" "$job")"
    "$program" "$@" "$job" --help | sed -e 's/^[Uu]sage:/\nUsage:/' -e 's/^[Oo]ptions:/Its options:/'
    text_of_jobs "$@" "$job"
  done
}

folder=$(mktemp -d)
trap 'rm -r "$folder"' EXIT
{
  "$program" --help | sed -e 's/^usage:/Usage:/' -e 's/^options:/Options:/'
  text_of_jobs
} >"$folder/text"
# A program that says all this by itself.
told=$folder/$(basename "$program")
printf '#!/bin/sh\ncat "%s/text"\n' "$folder" >"$told"
chmod +x "$told"
# What it does, for the page's head and whatis: the first sentence of its help.
purpose=$(sed -n '/^Usage:/!{/[^ ]/{s/[.:] .*//;s/\.$//;p;q}}' "$folder/text")
mkdir -p "$(dirname "$page")"
"${HELP2MAN:-help2man}" --name "$purpose" --no-info --no-discard-stderr --version-string "$version" --output "$page" "$told"
gzip -9nf "$page"
