# Completion for fish: what the completion for bash finds.
set -g __talus_completion (status dirname)/../../bash-completion/completions/talus
complete -c talus -f -a '(bash $__talus_completion (commandline -opc) (commandline -ct))'
