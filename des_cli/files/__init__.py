"""Everything that touches a file: profiles in, tables and run folders out."""
