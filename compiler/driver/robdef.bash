# SPDX-License-Identifier: Apache-2.0
# bash completion of robdef

_robdef() {
  local word=$2 previous=$3 command=${COMP_WORDS[1]}
  local reading='--import-path -I --format --no-warning --help'
  COMPREPLY=()
  if [ "$COMP_CWORD" = 1 ]; then
    mapfile -t COMPREPLY < <(compgen -W \
      'generate check describe model view explain inspect record replay bridge --help --version' -- "$word")
    return
  fi
  case $previous in
    --lang)
      mapfile -t COMPREPLY < <(compgen -W \
        "$(robdef --help 2>/dev/null | sed -n '/^Languages:/,/^$/s/^  \([a-z]*\) .*/\1/p')" -- "$word")
      return
      ;;
    --format)
      mapfile -t COMPREPLY < <(compgen -W 'text line json' -- "$word")
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
    --output | -o | --import-path | -I | --templates)
      mapfile -t COMPREPLY < <(compgen -d -- "$word")
      return
      ;;
    --entries)
      mapfile -t COMPREPLY < <(compgen -W 'PropertyGetReq PropertyGetRes PropertySetReq PropertySetRes FunctionCallReq
        FunctionCallRes GeneratorNextReq GeneratorNextRes EventReq PipePacket PipePacketRet CallbackCallReq
        CallbackCallRet WirePacket MemoryRead MemoryReadRet MemoryWrite' -- "$word")
      return
      ;;
    --depfile)
      mapfile -t COMPREPLY < <(compgen -f -- "$word")
      return
      ;;
  esac
  if [[ $word == -* ]]; then
    local options
    case $command in
      generate)
        options="--lang --output -o --templates --list-outputs --depfile --depfile-target $reading" ;;
      check) options="--strict $reading" ;;
      view) options="--lang $reading" ;;
      describe | model) options=$reading ;;
      explain) options='--list --json --help' ;;
      inspect) options='--json --entries --path --connection --summary --help' ;;
      record) options='--connect --listen --everywhere --output -o --drop --help' ;;
      bridge) options='--listen --everywhere --help' ;;
      replay) options='--connect --listen --everywhere --connection --fast --help' ;;
    esac
    mapfile -t COMPREPLY < <(compgen -W "$options" -- "$word")
  elif [ "$command" = explain ]; then
    mapfile -t COMPREPLY < <(compgen -W \
      "$(robdef explain --list 2>/dev/null | cut -d ' ' -f 1)" -- "$word")
  elif [ "$command" = inspect ] || [ "$command" = replay ] || [ "$command" = bridge ]; then
    mapfile -t COMPREPLY < <(compgen -f -- "$word")
  else
    mapfile -t COMPREPLY < <(
      compgen -f -X '!*.robdef' -- "$word"
      compgen -d -S / -- "$word"
    )
  fi
}
complete -o filenames -F _robdef robdef
