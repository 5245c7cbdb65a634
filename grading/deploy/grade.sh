#!/usr/bin/env bash
# Judges one submission by the queue of docs/teacher/queue.md, with the options of grade.sh of the grading scripts of TRIK TestSys
# (github.com/trik-testsys/grading-scripts): a service that calls that script calls this one instead.
#
# The workers have the fields already, as a task that is called as the directory of the fields, or as the one above if that is
# called "fields". TRIK_SERVER names the server (127.0.0.1), TRIK_USER and TRIK_PASSWORD_FILE who asks, TRIK_CA who vouches for it,
# and TRIK the program (trik).
#
# Exit status: 0 there is a report FIELD.json for each field, whatever the verdict; 1 there is not.
set -euo pipefail

usage() {
    cat <<'TEXT'
Usage: grade.sh OPTION...
Judge a submission by the queue at $TRIK_SERVER (127.0.0.1).

--mode MODE               what it is: qrs, js or py
--submission-file FILE    the submission
--fields-directory DIR    the fields; its name, or the one above "fields", is the task of the workers
--result-directory DIR    for the reports: DIR/FIELD.json
--verbose                 print the result as a line of JSON too
--help                    print this

Taken and without effect, as the workers have their own: --inputs-directory DIR (a text FIELD.txt beside FIELD.xml of the task),
--image IMAGE. Taken and without effect, with a word: --video-directory DIR, --debug-directory DIR.
TEXT
}

fail() {
    echo "grade.sh: $*" >&2
    exit 1
}

mode='' submission='' fields='' results='' verbose=''
while (($#)); do
    case $1 in
    --help)
        usage
        exit 0
        ;;
    --verbose)
        verbose=1
        shift
        continue
        ;;
    --mode | --submission-file | --fields-directory | --result-directory | --inputs-directory | --video-directory | \
        --debug-directory | --image) ;;
    *) fail "unknown option $1; --help tells which there are" ;;
    esac
    (($# > 1)) || fail "$1 needs a value"
    case $1 in
    --mode) mode=$2 ;;
    --submission-file) submission=$2 ;;
    --fields-directory) fields=$2 ;;
    --result-directory) results=$2 ;;
    --video-directory | --debug-directory) echo "grade.sh: nothing is written for $1" >&2 ;;
    --inputs-directory | --image) ;;
    esac
    shift 2
done

case $mode in
qrs | js | py) ;;
*) fail "--mode is qrs, js or py, not '$mode'" ;;
esac
[[ -f $submission ]] || fail "--submission-file: there is no file '$submission'"
[[ -d $fields ]] || fail "--fields-directory: there is no directory '$fields'"
[[ -d $results ]] || fail "--result-directory: there is no directory '$results'"

fields=$(realpath -- "$fields")
[[ ${fields##*/} != fields ]] || fields=${fields%/*}
task=${fields##*/}

# What it is, is told by its ending.
folder=$(mktemp -d)
trap 'rm -rf -- "$folder"' EXIT
name=${submission##*/}
file=$folder/${name%.*}.$mode
cp -- "$submission" "$file"

options=(--server "${TRIK_SERVER:-127.0.0.1}")
[[ -z ${TRIK_USER:-} ]] || options+=(--user "$TRIK_USER" --password-file "${TRIK_PASSWORD_FILE:?}")
[[ -z ${TRIK_CA:-} ]] || options+=(--ca "$TRIK_CA")
# The verdict is in the reports: a failed solution is no failure of this script.
result=$("${TRIK:-trik}" grade-submit "$file" --task "$task" --wait --report "$results" "${options[@]}") || true
[[ -n $result ]] || fail "there is no result"
[[ -z $verbose ]] || echo "$result"
