"""What a reduction gained and what it cost, measured and put into words."""
