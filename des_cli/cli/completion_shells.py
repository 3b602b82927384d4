"""How bash, zsh and fish are told completions: as click does it, but for ``KEY=VALUE`` and lists.

A key that ends with ``=`` is followed by its value and not by a space. Bash takes ``=`` for the
end of a word, and click's script for fish takes a comma for the end of a value.
"""

from __future__ import annotations

from click.shell_completion import (
    BashComplete,
    CompletionItem,
    FishComplete,
    ZshComplete,
    add_completion_class,
)

_BASH_PLAIN = "            COMPREPLY+=($value)\n"
_BASH_NO_SPACE = "            [[ $value == *= ]] && compopt -o nospace\n"

_ZSH_PLAIN = '        if [[ "$type" == "plain" ]]; then\n'
_ZSH_NO_SPACE = """\
        if [[ "$type" == "plain" && "$key" == *= ]]; then
            compadd -U -S '' -- "$key"
        elif [[ "$type" == "plain" ]]; then
"""

_FISH_SPLIT, _FISH_SPLIT_ONCE = 'string split ","', 'string split -m 1 ","'


class Bash(BashComplete):
    """Bash, which hands ``KEY=VALUE`` over in three words, and replaces the last one."""

    source_template = BashComplete.source_template.replace(
        _BASH_PLAIN, _BASH_PLAIN + _BASH_NO_SPACE
    )
    _before = ""

    def get_completion_args(self) -> tuple[list[str], str]:
        """Return the words before the one to complete, and this."""
        args, incomplete = super().get_completion_args()
        words: list[str] = []
        for word in (*args, incomplete):
            if words and (word == "=" or (words[-1].endswith("=") and _is_open(words[-1]))):
                words[-1] += word
            else:
                words.append(word)
        last = words.pop()
        if "=" in last:
            # Of --option=KEY=VALUE the option is no part of what is completed.
            before = last[: last.rindex("=") + 1]
            self._before = before.partition("=")[2] if before.startswith("--") else before
        return words, last

    def format_completion(self, item: CompletionItem[str]) -> str:
        """Return a completion without what stands before the word that bash replaces."""
        return f"{item.type},{item.value.removeprefix(self._before)}"


class Zsh(ZshComplete):
    """Zsh, which sets no space after a key."""

    source_template = ZshComplete.source_template.replace(_ZSH_PLAIN, _ZSH_NO_SPACE)


class Fish(FishComplete):
    """Fish, which takes a list for one value."""

    source_template = FishComplete.source_template.replace(_FISH_SPLIT, _FISH_SPLIT_ONCE)


def _is_open(word: str) -> bool:
    """Tell whether a word ends in a sign that bash has cut off, and its value follows."""
    return word != "=" and word.endswith("=")


def register_shells() -> None:
    """Let click complete by these."""
    for shell in (Bash, Zsh, Fish):
        add_completion_class(shell)
