# SPDX-License-Identifier: Apache-2.0
# bash completion of robdef

# Members of the service at a URL. The words are counted anew: to bash the URL is several.
_robdef_members() {
  local line=${COMP_LINE:0:COMP_POINT} words word='' url='' each reply
  read -ra words <<< "$line"
  [[ $line == *[[:blank:]] ]] || word=${words[-1]}
  for each in "${words[@]}"; do
    each=${each//[\'\"]/}
    [[ $each != *://* || $each == "$word" ]] || url=$each
  done
  [ -n "$url" ] || return
  mapfile -t reply < <(robdef complete --timeout 2 "${words[1]}" "$url" "$word" 2>/dev/null < /dev/null)
  compopt +o filenames
  [[ ${reply[0]-} != *[.[] ]] || compopt -o nospace
  COMPREPLY=("${reply[@]}")
}

_robdef() {
  local word=$2 previous=$3 command=${COMP_WORDS[1]}
  local reading='--import-path -I --format --deny --warn --allow --no-warning --config --no-config --help'
  COMPREPLY=()
  if [ "$COMP_CWORD" = 1 ]; then
    mapfile -t COMPREPLY < <(compgen -W \
      'generate check format breaking docs describe model view explain inspect record replay bridge ca discover lsp get set call watch top connect
      --help --version' -- "$word")
    return
  fi
  case $previous in
    --lang)
      mapfile -t COMPREPLY < <(compgen -W \
        "$(robdef --help 2>/dev/null | sed -n '/^Languages:/,/^$/s/^  \([a-z]*\) .*/\1/p')" -- "$word")
      return
      ;;
    --format)
      if [ "$command" = breaking ]; then
        mapfile -t COMPREPLY < <(compgen -W 'text json github' -- "$word")
        return
      fi
      if [ "$command" = docs ]; then
        mapfile -t COMPREPLY < <(compgen -W 'html markdown' -- "$word")
        return
      fi
      mapfile -t COMPREPLY < <(compgen -W 'text line json' -- "$word")
      return
      ;;
    --category)
      mapfile -t COMPREPLY < <(compgen -W 'wire source behaviour' -- "$word")
      return
      ;;
    --allow | --warn | --deny)
      if [ "$command" != breaking ]; then
        mapfile -t COMPREPLY < <(compgen -W \
          "$(robdef explain --list 2>/dev/null | awk '$3 == "warning" || $2 == "warning" || !/^R[01]/ {print $1}')" \
          -- "$word")
        return
      fi
      mapfile -t COMPREPLY < <(compgen -W \
        "$(robdef explain --list 2>/dev/null | awk '/^R07/ {print $1}')" -- "$word")
      return
      ;;
    --no-warning)
      mapfile -t COMPREPLY < <(compgen -W \
        "$(robdef explain --list 2>/dev/null | awk '$3 == "warning" || $2 == "warning" {print $1}')" \
        -- "$word")
      return
      ;;
    --output | -o)
      if [ "$command" = record ]; then
        mapfile -t COMPREPLY < <(compgen -f -- "$word")
        return
      fi
      ;;&
    --output | -o | --import-path | -I | --templates | --ca)
      mapfile -t COMPREPLY < <(compgen -d -- "$word")
      return
      ;;
    --entries)
      mapfile -t COMPREPLY < <(compgen -W 'PropertyGetReq PropertyGetRes PropertySetReq PropertySetRes FunctionCallReq
        FunctionCallRes GeneratorNextReq GeneratorNextRes EventReq PipePacket PipePacketRet CallbackCallReq
        CallbackCallRet WirePacket MemoryRead MemoryReadRet MemoryWrite' -- "$word")
      return
      ;;
    --plugin)
      mapfile -t COMPREPLY < <(compgen -f -- "$word"; compgen -c -- "$word")
      return
      ;;
    --config | --depfile | --password-file | --passphrase-file | --tls-authority | --tls-revocation | --tls-certificate | --tls-key)
      mapfile -t COMPREPLY < <(compgen -f -- "$word")
      return
      ;;
  esac
  local tls='--tls-authority --tls-revocation --tls-certificate --tls-key --require-tls'
  local live="--user --password-file --timeout $tls"
  if [[ $word == -* ]]; then
    local options
    case $command in
      generate)
        options="--lang --plugin --plugin-option --output -o --templates --rename --list-outputs --depfile --depfile-target $reading" ;;
      check) options="--strict --lang $reading" ;;
      format) options="--check --help" ;;
      breaking) options="--import-path -I --format --category --allow $live --help" ;;
      docs) options="--output -o --list-outputs --depfile --depfile-target $reading" ;;
      view) options="--lang --rename $reading" ;;
      describe) options="$reading $live" ;;
      model) options=$reading ;;
      get) options="--at --count $live --help" ;;
      set) options="--at $live --help" ;;
      call) options="--count $live --help" ;;
      watch) options="--count --for $live --help" ;;
      top) options="--count --for --every $live --help" ;;
      connect) options="$live --help" ;;
      explain) options='--list --json --help' ;;
      inspect) options='--json --entries --path --connection --summary --page --help' ;;
      record) options='--connect --listen --everywhere --output -o --drop --keep-credentials --help' ;;
      discover) options="--once --type --format --wait --ipv4 --interface --port $tls --help" ;;
      lsp) options='--stdio --import-path -I --help' ;;
      bridge) options="--listen --everywhere $tls --help" ;;
      replay) options='--connect --listen --everywhere --connection --fast --tolerance --ignore --help' ;;
      ca)
        options='--ca --days --list-days --name --renew --new-key --revoke-old --passphrase --passphrase-file
          --output -o --json --help' ;;
    esac
    mapfile -t COMPREPLY < <(compgen -W "$options" -- "$word")
  elif [ "$command" = explain ]; then
    mapfile -t COMPREPLY < <(compgen -W \
      "$(robdef explain --list 2>/dev/null | cut -d ' ' -f 1)" -- "$word")
  elif [[ $command == @(get|set|call|watch|top|connect) || $COMP_LINE == *describe*://* ]]; then
    _robdef_members
  elif [ "$command" = ca ] && [ "$COMP_CWORD" = 2 ]; then
    mapfile -t COMPREPLY < <(compgen -W 'init issue request sign revoke refresh list passphrase' -- "$word")
  elif [ "$command" = bridge ] || [ "$command" = ca ] || [ "$command" = inspect ] || [ "$command" = replay ]; then
    mapfile -t COMPREPLY < <(compgen -f -- "$word")
  else
    mapfile -t COMPREPLY < <(
      compgen -f -X '!*.robdef' -- "$word"
      compgen -d -S / -- "$word"
    )
  fi
}
complete -o filenames -F _robdef robdef
