# SPDX-License-Identifier: Apache-2.0
"""`eel completion`: print the shell code that completes commands and options in bash or zsh.

bash: eval "$(eel completion bash)"     zsh: eval "$(eel completion zsh)"
"""

import argparse

from eel_common.command.command import command
from eel_common.command.command_line import Parser
from eel_common.command.suite import commands


def _add_options(parser: Parser) -> None:
    parser.add_argument("shell", choices=("bash", "zsh"))


@command("eel completion", "Print a shell's completion of eel, for eval in its start file.", add_options=_add_options)
def main(options: argparse.Namespace) -> None:
    """Print it. Without argcomplete, only the names of the commands are completed."""
    try:
        from argcomplete import shellcode
    except ImportError:
        first = "autoload -U +X bashcompinit && bashcompinit\n" if options.shell == "zsh" else ""
        print(f"{first}complete -o default -W '{' '.join(commands())}' eel")
    else:
        print(shellcode(["eel"], shell=options.shell))
