"""Finds what has grown too large in C++ source: python3 check_sizes.py FOLDER... [--list]

A file may have 600 lines, a function 80 lines and 6 parameters, blocks of control flow may be nested
4 deep. A function that must nest deeper says why in a comment that begins with "Nested because".
Prints what is larger, one line each, and then exits with 1; --list prints the ten largest of each
kind instead.
"""

import pathlib
import re
import sys

MOST = {'lines of a file': 600, 'lines': 80, 'parameters': 6, 'nested blocks': 4}
CONTROL = {'if', 'for', 'while', 'switch', 'do', 'else', 'try', 'catch'}
TOKEN = re.compile(r'"(?:\\.|[^"\\\n])*"|\'(?:\\.|[^\'\\\n])\'|\d[\w.\']*|[A-Za-z_]\w*|::|->|[^\s\w]')


def without_comments(text):
    """The text with comments, raw strings and preprocessor lines blanked, line by line."""

    def blank(match):
        return re.sub(r'[^\n]', ' ', match.group())

    def strings_stay(match):
        return match.group() if match.group()[0] in '"\'' else blank(match)

    text = re.sub(r'R"(\w*)\((?:.|\n)*?\)\1"', lambda m: '""' + blank(m)[2:], text)
    text = re.sub(r'"(?:\\.|[^"\\\n])*"|(?<!\w)\'(?:\\.|[^\'\\\n])\'|//[^\n]*|/\*(?:.|\n)*?\*/', strings_stay, text)
    return re.sub(r'^[ \t]*#(?:[^\n]*\\\n)*[^\n]*', blank, text, flags=re.M)


def tokens_of(text):
    line = 1
    last = 0
    for match in TOKEN.finditer(text):
        line += text.count('\n', last, match.start())
        last = match.start()
        yield match.group(), line


def count_parameters(header):
    """Of the first pair of brackets behind a name; commas inside brackets of any kind do not count."""
    start = header.index('(')
    if start and header[start - 1] == 'operator':
        start = header.index('(', start + 1)
    depth = 0
    commas = 0
    is_empty = True
    for token in header[start:]:
        if token in '([{<':
            depth += 1
        elif token in ')]}>':
            depth -= 1
            if depth == 0:
                break
        elif depth == 1 and token == ',':
            commas += 1
        if depth and token not in '(':
            is_empty = False
    return 0 if is_empty else commas + 1


def name_in(header):
    start = header.index('(')
    if 'operator' in header[:start + 1]:
        return 'operator' + header[header.index('operator') + 1]
    name = header[start - 1]
    if start > 2 and header[start - 2] == '::':
        name = header[start - 3] + '::' + name
    return name


def is_function(header):
    """Whether a brace behind these tokens opens the body of a function."""
    if '(' not in header or header[0] in ('namespace', 'enum', 'extern'):
        return False
    start = header.index('(')
    if start == 0 or '=' in header[:start] and 'operator' not in header[:start]:
        return False
    if header[-1] == ')' or header[-1] in ('const', 'noexcept', 'override', 'final', 'try', '}'):
        return True
    return '->' in header and ':' not in header


class Function:
    def __init__(self, header, line):
        self.name = name_in(header)
        self.line = line
        self.parameters = count_parameters(header)
        self.lines = 0
        self.deepest = 0


def functions_of(text):
    """The functions that are defined in a source text; lambdas belong to the function around."""
    tokens = list(tokens_of(without_comments(text)))
    scopes = []  # per open brace: 'outer', 'function', 'control', 'single' (without brace), 'other'
    header = []
    function = None
    found = []
    i = 0
    while i < len(tokens):
        token, line = tokens[i]
        i += 1
        if function is None:
            if token == ';' or (token == ':' and header and header[-1] in ('public', 'private', 'protected')):
                header = []
            elif token == '}':
                if scopes and scopes.pop() == 'outer':
                    header = []
                else:
                    header.append(token)
            elif token == '{':
                words = [t for t, _ in header]
                is_open = any(scope != 'outer' for scope in scopes)
                if not is_open and words and is_function(words):
                    function = Function(words, header[0][1])
                    scopes.append('function')
                    header = []
                elif words and not is_open and ('namespace' in words or ({'class', 'struct'} & set(words) and '(' not in words and '=' not in words)):
                    scopes.append('outer')
                    header = []
                else:
                    scopes.append('other')
                    header.append((token, line))
                    continue
            else:
                header.append((token, line))
            if header and isinstance(header[-1], str):
                header[-1] = (header[-1], line)
            continue
        if token in CONTROL:
            if token == 'else' and tokens[i][0] == 'if':
                i += 1
                token = 'if'
            if token == 'while' and scopes[-1] != 'function' and tokens[i - 2][0] == '}' and is_end_of_do(tokens, i):
                continue
            if tokens[i][0] == 'constexpr':
                i += 1
            if tokens[i][0] == '(':
                i = behind_brackets(tokens, i)
            if tokens[i][0] == '{':
                scopes.append('control')
                i += 1
            else:
                scopes.append('single')
            function.deepest = max(function.deepest, sum(s in ('control', 'single') for s in scopes))
        elif token == '{':
            scopes.append('other')
        elif token == '}':
            while scopes[-1] == 'single':
                scopes.pop()
            if scopes.pop() == 'function':
                function.lines = line - function.line + 1
                found.append(function)
                function = None
            elif scopes[-1] == 'single' and tokens[i][0] not in (',', ')', ';', '('):
                while scopes[-1] == 'single':
                    scopes.pop()
        elif token == ';':
            while scopes[-1] == 'single':
                scopes.pop()
    return found


def is_end_of_do(tokens, i):
    return tokens[behind_brackets(tokens, i)][0] == ';'


def behind_brackets(tokens, i):
    depth = 0
    while True:
        depth += (tokens[i][0] == '(') - (tokens[i][0] == ')')
        i += 1
        if depth == 0:
            return i


def measure(path):
    """What there is to judge in a file: (kind, size, what)."""
    text = path.read_text()
    lines = text.split('\n')
    yield 'lines of a file', len(lines) - 1, str(path)
    for function in functions_of(text):
        what = f'{path}:{function.line}: {function.name}'
        yield 'lines', function.lines, what
        yield 'parameters', function.parameters, what
        first = max(0, function.line - 6)
        if 'Nested because' not in '\n'.join(lines[first:function.line + function.lines]):
            yield 'nested blocks', function.deepest, what


def measured(folders):
    return [entry for folder in folders for path in sorted(folder.rglob('*'))
            if path.suffix in ('.h', '.cpp') for entry in measure(path)]


def faults_in(folders):
    """Whole sentences about what is too large."""
    return [f'{what}: {size} {kind}, expected at most {MOST[kind]}'
            for kind, size, what in measured(folders) if size > MOST[kind]]


def main():
    folders = [pathlib.Path(a) for a in sys.argv[1:] if not a.startswith('--')]
    found = measured(folders)
    if not found:
        sys.exit(f'no source in {", ".join(map(str, folders))}')
    if '--list' in sys.argv:
        for kind, most in MOST.items():
            print(f'{kind} (at most {most}):')
            for _, size, what in sorted((e for e in found if e[0] == kind), key=lambda e: -e[1])[:10]:
                print(f'  {size:5} {what}')
        return
    faults = faults_in(folders)
    for fault in faults:
        print(fault)
    sys.exit(1 if faults else 0)


if __name__ == '__main__':
    main()
