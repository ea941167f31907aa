// What a shell has to know: which program to call, and what to do with its answer.
#include "program/completion.h"

namespace plab::program
{
namespace
{

// Bash cuts words at '=' and ':', which stand in values here: the words are taken from the line, and of a candidate only what stands
// behind the last of these goes back.
constexpr const char* kBash = R"(# Completion of %NAME% for bash: what may stand at the cursor is asked of %NAME% itself.
_plab_complete()
{
    local line=${COMP_LINE:0:COMP_POINT} word
    local -a words
    read -ra words <<<"$line"
    [[ $line == *[[:space:]] ]] && words+=("")
    local current=${words[-1]}
    local before=${current%"${current##*[=:]}"}
    COMPREPLY=()
    while IFS=$'\t' read -r word _; do
        case $word in
            :files)
                compopt -o filenames
                while IFS= read -r word; do COMPREPLY+=("$word"); done < <(compgen -f -- "${current#"$before"}")
                ;;
            :nospace) compopt -o nospace ;;
            *) COMPREPLY+=("${word#"$before"}") ;;
        esac
    done < <("$1" --complete "${words[@]:1}" 2>/dev/null)
}
complete -F _plab_complete %NAME%
)";

constexpr const char* kZsh = R"(#compdef %NAME%
# Completion of %NAME% for zsh: what may stand at the cursor is asked of %NAME% itself.
_plab_%NAME%()
{
    local -a found rest
    local word help
    while IFS=$'\t' read -r word help; do
        case $word in
            :files) _files ;;
            :nospace) rest=(-S '') ;;
            *) found+=("${word//:/\\:}:$help") ;;
        esac
    done < <("${words[1]}" --complete "${(@Q)words[2,CURRENT-1]}" "${(Q)PREFIX}" 2>/dev/null)
    (( $#found )) && _describe '%NAME%' found "${rest[@]}"
}
if [[ ${funcstack[1]} == _%NAME% ]]; then
    _plab_%NAME%
else
    compdef _plab_%NAME% %NAME%
fi
)";

constexpr const char* kFish = R"(# Completion of %NAME% for fish: what may stand at the cursor is asked of %NAME% itself.
function __plab_complete
    set -l words (commandline -opc)
    set -l current (commandline -ct)
    for line in ($words[1] --complete $words[2..] "$current" 2>/dev/null)
        switch $line
            case ':files*'
                __fish_complete_path "$current"
            case ':*'
            case '*'
                printf '%s\n' $line
        end
    end
end
complete -c %NAME% -f -a '(__plab_complete)'
)";

}  // namespace

std::string completion_script(const std::string& program, const std::string& shell)
{
    constexpr std::string_view kName = "%NAME%";
    std::string out = shell == "bash" ? kBash : shell == "zsh" ? kZsh : shell == "fish" ? kFish : "";
    for (std::size_t at = 0; (at = out.find(kName, at)) != std::string::npos; at += program.size()) out.replace(at, kName.size(), program);
    return out;
}

}  // namespace plab::program
