"""What the documentation has of commands and configurations: found in Markdown, in its order."""
import re
import shlex
from dataclasses import dataclass

# Words that stand for something else, and signs of a synopsis: such a command cannot be run as it stands.
PLACEHOLDER = re.compile(r"[\[\]|]|\.\.\.|(?<![\w./-])[A-Z][A-Z]+(?:\.html)?(?![\w./-])|(?<![\w.-])N(?![\w.-])")
# Preparation by the shell that stands between commands; run as it is.
SHELL_LINE = re.compile(r"^(?:cp|cut|grep|mkdir|tar) ")
SECTION = re.compile(r"^(?:[a-z_]+): ?(?:\{.*\}|[^{]*)(?:\s+#.*)?$")


@dataclass(frozen=True)
class Command:
    text: str        # one line, without comment and prompt; "edgeslam ..." or a line for the shell
    is_code: bool    # it stands in a block of code, not in a sentence

    @property
    def words(self):
        return shlex.split(self.text)

    @property
    def is_name(self):
        """In a sentence: a subcommand's name rather than a command to be typed."""
        return not self.is_code and len(self.words) <= 2 and not self.words[-1].startswith("-")

    @property
    def is_template(self):
        return PLACEHOLDER.search(self.text) is not None

    @property
    def subcommand(self):
        words = [word for word in self.words[1:3] if re.fullmatch(r"[a-z-]+", word) and not word.startswith("-")]
        if words in (["calibrate", "board"], ["map", "info"], ["map", "join"], ["map", "crop"]):
            return words
        return words[:1]

    @property
    def options(self):
        return sorted(set(re.findall(r"(?<![\w-])--[a-z][a-z-]*", self.text)))


def split(markdown):
    """Blocks of code (lists of lines) and sentences (strings), in order."""
    parts, code, prose, fenced = [], [], [], False

    def flush():
        if code:
            parts.append(list(code))
        if prose:
            parts.append(" ".join(prose))
        code.clear()
        prose.clear()

    for line in markdown.splitlines():
        if line.startswith("```"):
            fenced = not fenced
            flush()
        elif fenced or re.match(r" {4,}\S", line):
            if prose:
                flush()
            code.append(line)
        else:
            if code and line.strip():
                flush()
            prose.append(line)
    flush()
    return parts


def commands_of_block(lines):
    found = []
    for line in lines:
        text = re.sub(r"\s+#.*$", "", line.strip())
        text = re.sub(r"^\$ ", "", text)
        text = re.sub(r"^build/release/edgeslam\b", "edgeslam", text)
        if re.match(r"edgeslam\s", text) or SHELL_LINE.match(text):
            found.append(text)
        elif found and text.startswith("[") and "[" in found[-1]:  # a synopsis goes on
            found[-1] += " " + text
    return [Command(re.sub(r"\s+", " ", text), True) for text in found]


def commands_of(markdown):
    found = []
    for part in split(markdown):
        if isinstance(part, list):
            found += commands_of_block(part)
            continue
        for code in re.findall(r"`([^`]+)`", part):
            if re.match(r"edgeslam\s", code):
                found.append(Command(re.sub(r"\s+", " ", code), False))
    return found


def configurations_of(markdown):
    """Texts of YAML: blocks that begin with a section, and snippets of one section in sentences."""
    found = []
    for part in split(markdown):
        if isinstance(part, list):
            lines = [line for line in part if line.strip() and not line.strip().startswith("#")]
            if lines and SECTION.match(lines[0].strip()) and not re.search(r"[;=]", lines[0].split("#")[0]):
                indent = len(part[0]) - len(part[0].lstrip())
                found.append("\n".join(line[indent:] for line in part) + "\n")
        else:
            found += [code + "\n" for code in re.findall(r"`([a-z_]+: \{[^`]*\})`", part)]
    return found
