function tokens = matlab_tokens(line)
%MATLAB_TOKENS The words, numbers, texts, signs and comments of a line, in cells; spaces are tokens, too.
%   A quote behind a word, a number or a closing bracket is a transpose, as in MATLAB and in Octave.
pattern = ['(?<=[\w)\]}''.])''', ...                  % transpose
           '|''(?:[^'']|'''')*''|"(?:[^"\\]|\\.|"")*"', ...  % texts
           '|%.*|#.*|\.\.\..*', ...                       % comments
           '|[A-Za-z_]\w*|\d+(?:\.\d+)?(?:[eE][+-]?\d+)?', ...
           '|\.[''^*/\\]|[=~<>!]=|&&|\|\||\+\+|--|\*\*|[-+*/^|&]=|\s+|.'];
tokens = regexp(line, pattern, 'match');
end
