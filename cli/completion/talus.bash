# Completion for bash: calls, options and the choices of an option are those that the program's help lists.
# Run as a program with the words of a line, it prints the completions of the last one, for the other shells.
_talus() {
  local cur=${COMP_WORDS[COMP_CWORD]} prev=${COMP_WORDS[COMP_CWORD - 1]} word call= help calls choices
  help=$("${COMP_WORDS[0]}" help)
  calls=$(sed -n 's/^  \([a-z][a-z]*\)  .*/\1/p' <<< "$help")
  for word in "${COMP_WORDS[@]:1:COMP_CWORD-1}"; do
    if [[ " ${calls//$'\n'/ } " == *" $word "* ]]; then call=$word; break; fi
  done
  [[ -z $call ]] || help+=$'\n'$("${COMP_WORDS[0]}" help "$call")
  choices=$(awk -v option="$prev" '/^  [^ ]/ { found = "," $1 "," ~ "," option "," } found' <<< "$help" |
            tr -s '\n ' ' ' | sed -n 's/.*[[ ]one of \([^];]*\)[];].*/\1/p')
  if [[ $prev == -* && -n $choices ]]; then
    COMPREPLY=($(compgen -W "${choices//,/}" -- "$cur"))
  elif [[ $cur == -* ]]; then
    COMPREPLY=($(compgen -W "$(grep -oE '^  -[^ ]+' <<< "$help" | tr ',' '\n')" -- "$cur"))
  elif [[ -z $call || $call == help ]]; then
    COMPREPLY=($(compgen -W "$calls" -- "$cur"))
  else
    COMPREPLY=($(compgen -f -- "$cur"))
  fi
}
if [[ ${BASH_SOURCE[0]} == "$0" ]]; then
  COMP_WORDS=("$@") COMP_CWORD=$(($# - 1))
  _talus
  printf '%s\n' "${COMPREPLY[@]}"
else
  complete -o filenames -F _talus talus
fi
