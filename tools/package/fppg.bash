# Completion of fppg's arguments for bash.

_fppg()
{
    local word=${COMP_WORDS[COMP_CWORD]} before=${COMP_WORDS[COMP_CWORD-1]} command=${COMP_WORDS[1]}
    local options= endings=
    case $COMP_CWORD:$command in
        1:*) ;;
        *:batch)
            options="--out --set --jobs --threads --memory --resume --no-pictures --quiet --log-json --slurm --submit
                --plan --task --summary --dry-run --help" ;;
        *:check)
            options="--json --vtk --strict --motion --definition --evars --dp --end --step --passages --threads --help" ;;
        *:compare)
            options="--json --html --stl --definition --tolerance --tolerance-density --tolerance-velocity --tolerance-normal
                --tolerance-constants --examples --memory --quiet --threads --help" ;;
        *:convert) options="--output --to --case-xml --threads --help" ;;
        *:estimate) options="--json --calibrate -dp: -evars: -fit -save: -threads: --help" ;;
        *:inspect) options="--dp --unit --angle --weld --part --json --threads --help" endings="stl ply vtk vtp vtu obj off csv" ;;
        *:leak) options="--json --plot --definition --evars --tolerance --threads --help" ;;
        *:new)
            options="--output --kind --unit --up --dp --particles --across --housing --rotate --fix --float --fill --inlet --water
                --speed --time --picture --no-picture --allow-far --allow-overlap --explain --json --no-questions --threads --help"
            endings="stl ply vtk vtp vtu obj off step stp" ;;
        *:render)
            options="--output --view --color --colour --mk --cut --zoom --center --size --radius --samples --palette --closed --bare
                --threads --help" ;;
        *:report) options="--output --stl --definition --particles --picture --data --quiet --threads --help" ;;
        *:templates) options="--overwrite --help" ;;
        *:upgrade) options="--output --in-place --help" endings="xml" ;;
        *) options="-dp: -evars: -fit -fit:raw -fit:off -strict -threads: -memory: -save: -save:all -to: -save3vtk: -createdirs: -debug:
                -quiet -log-json -clean" ;;
    esac
    COMPREPLY=()
    if [[ $COMP_CWORD -eq 1 && $word != -* ]]; then
        COMPREPLY=($(compgen -W "batch check compare convert estimate inspect leak new render report templates upgrade" -- "$word"))
    elif [[ $COMP_CWORD -eq 1 ]]; then
        COMPREPLY=($(compgen -W "-h --help -ver --version -info -templates" -- "$word"))
    elif [[ $word == -* ]]; then
        COMPREPLY=($(compgen -W "$options" -- "$word"))
        [[ ${COMPREPLY-} == *: ]] && compopt -o nospace
    fi
    [[ $word == -* ]] && return
    compopt -o filenames
    # Definitions and results are named without extension.
    local file
    while IFS= read -r file; do
        if [[ -d $file || -n $endings || $before == -* ]]; then
            COMPREPLY+=("$file")
        elif [[ $file == *_Def.xml || $file == *.bi4 ]]; then
            COMPREPLY+=("${file%.*}")
        elif [[ $file == *.vtk ]]; then
            COMPREPLY+=("$file")
        fi
    done < <(compgen -f -- "$word")
}
complete -F _fppg fppg GenCase_linux64
