# Completion of plabctl for bash: source this file, or copy it to /usr/share/bash-completion/completions/plabctl.
# Ids, types and servers are asked for on the bus, with the options that stand on the line already.

_plabctl_ids()
{
    local ids="" list
    for list in "$@"; do
        # The first column, without its title.
        ids+=" $(timeout 3 plabctl "${_plabctl_globals[@]}" --timeout 1 "$list" 2>/dev/null | awk 'NR > 1 { print $1 }')"
    done
    echo "$ids"
}

_plabctl()
{
    local commands="servers objects interactions types show watch add remove swap set push pause resume step rate dt reset load
        shutdown wait topics"
    local globals="--server --domain --interface --timeout --json --color --count --duration --help --version"
    local current=${COMP_WORDS[COMP_CWORD]} previous=${COMP_WORDS[COMP_CWORD - 1]}
    local command="" i word
    local -a _plabctl_globals=()
    COMPREPLY=()

    for ((i = 1; i < COMP_CWORD; ++i)); do
        word=${COMP_WORDS[i]}
        case $word in
            -s | --server | --domain | --interface)
                _plabctl_globals+=("$word" "${COMP_WORDS[i + 1]}")
                ((++i))
                ;;
            --timeout | --color | -n | --count | -d | --duration | --to | --param | --at | --revision | --impulse | --point | \
                --every | --only | --family | --for | --step | --time | --partition)
                ((++i))
                ;;
            -*) ;;
            *) [[ -z $command ]] && command=$word ;;
        esac
    done

    local words=""
    case $previous in
        --color) words="auto always never" ;;
        -s | --server) words=$(_plabctl_ids servers) ;;
        --to) words=$(_plabctl_ids types) ;;
        --for) words=$(_plabctl_ids objects interactions) ;;
        --only) words=$(_plabctl_ids objects interactions) ;;
        --interface) words=$(ls /sys/class/net 2>/dev/null) ;;
        --domain | --timeout | -n | --count | -d | --duration | --param | --at | --revision | --impulse | --point | --every | \
            --family | --step | --time | --partition) return ;;
        *)
            case $command in
                "") words="$commands $globals" ;;
                show) words="$(_plabctl_ids objects interactions types) $globals" ;;
                swap) words="$(_plabctl_ids interactions objects) --to --param --at --revision $globals" ;;
                remove) words="$(_plabctl_ids objects interactions) --at --revision $globals" ;;
                push) words="$(_plabctl_ids objects) --impulse --point --at --revision $globals" ;;
                set) words="$(_plabctl_ids objects interactions) --at --revision $globals" ;;
                watch) words="states collisions events metrics --only --every $globals" ;;
                topics) words="list rate bandwidth print --partition --full $globals" ;;
                types) words="--family --for $globals" ;;
                rate) words="real max $globals" ;;
                wait) words="--step --time $globals" ;;
                add | load)
                    # shellcheck disable=SC2207
                    COMPREPLY=($(compgen -f -- "$current"))
                    return
                    ;;
                pause | resume | reset | dt) words="--at --revision $globals" ;;
                *) words=$globals ;;
            esac
            ;;
    esac
    # shellcheck disable=SC2207
    COMPREPLY=($(compgen -W "$words" -- "$current"))
    # "set ID" goes on with ".name=value".
    [[ $command == set && ${#COMPREPLY[@]} -eq 1 && ${COMPREPLY[0]} != -* ]] && COMPREPLY=("${COMPREPLY[0]}.") && compopt -o nospace
}

complete -F _plabctl plabctl
