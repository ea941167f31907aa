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
        shutdown cancel wait topics snapshot snapshots restore forget rewind branch shadow record play info export recover diff plot report log"
    local globals="--server --domain --interface --timeout --progress --json --color --count --duration --help --version"
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
                --every | --only | --family | --for | --step | --time | --partition | -o | --output | --topics | --until | \
                --compression | --state-rate | --rate | --from | --name | --readers | --topic | -q | --quantity | --by | --out | --log | --plabd | --with | --plot | --kind | --object | --severity)
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
        --to) [[ $command == swap ]] && words=$(_plabctl_ids types) ;;
        --compression) words="none lz4 zstd" ;;
        --topics) words="plab/states plab/events plab/collisions plab/metrics plab/journal plab/hashes plab/snapshots plab/images" ;;
        --topic) words="states collisions events metrics server objects interactions journal hashes snapshots" ;;
        --severity) words="info warning failure" ;;
        -o | --output | --plot)
            # shellcheck disable=SC2207
            COMPREPLY=($(compgen -f -- "$current"))
            return
            ;;
        --for) words=$(_plabctl_ids objects interactions) ;;
        --only) words=$(_plabctl_ids objects interactions) ;;
        --interface) words=$(ls /sys/class/net 2>/dev/null) ;;
        --domain | --timeout | -n | --count | -d | --duration | --param | --at | --revision | --impulse | --point | --every | \
            --family | --step | --time | --partition | --until | --state-rate | --rate | --from | --name | --readers | -q | --quantity | --by | --out | --log | --plabd | --with | \
            --kind | --object) return ;;
        *)
            case $command in
                "") words="$commands $globals" ;;
                show) words="$(_plabctl_ids objects interactions types) $globals" ;;
                swap) words="$(_plabctl_ids interactions objects) --to --param --trial --or-refuse --allow-energy --at --revision $globals" ;;
                remove) words="$(_plabctl_ids objects interactions) --at --revision $globals" ;;
                push) words="$(_plabctl_ids objects) --impulse --point --at --revision $globals" ;;
                set) words="$(_plabctl_ids objects interactions) --at --revision $globals" ;;
                watch) words="states collisions events metrics --only --every $globals" ;;
                topics) words="list rate bandwidth print --partition --full $globals" ;;
                types) words="--family --for $globals" ;;
                rate) words="real max $globals" ;;
                wait) words="--step --time $globals" ;;
                record) words="--output --overwrite --topics --until --compression --state-rate $globals" ;;
                info | export | recover | diff | plot | report | log)
                    case $command in
                        export) words="--csv --topic --from --to --output $globals" ;;
                        recover | report) words="--output $globals" ;;
                        diff) words="--plot $globals" ;;
                        plot) words="--quantity --output --from --to --no-events --log $globals" ;;
                        log) words="--events --collisions --kind --object --severity --from --to $globals" ;;
                        *) words=$globals ;;
                    esac
                    # shellcheck disable=SC2207
                    [[ $current != -* ]] && COMPREPLY=($(compgen -f -- "$current")) && return
                    ;;
                play)
                    words="--rate --from --to --loop --pause --name --readers $globals"
                    # shellcheck disable=SC2207
                    [[ $current != -* ]] && COMPREPLY=($(compgen -f -- "$current")) && return
                    ;;
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
