"""What a run leaves behind: tables and run folders, built aside and then named."""
