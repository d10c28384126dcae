"""What measured coordinates or a task determine: configurations, rates and accelerations."""
