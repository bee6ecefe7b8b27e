"""Scripts in other forms: laid out anew, as JSON, from Python."""
