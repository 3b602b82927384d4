"""What a run or a curve looks like to a person: words, figures and the page."""
